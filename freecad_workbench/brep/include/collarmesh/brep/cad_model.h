#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "collarmesh/brep/cad_formats.h"
#include "collarmesh/brep/cad_labels.h"
#include "collarmesh/geometry.h"
#include "collarmesh/polygon_soup.h"

class TopoDS_Shape;

/// CAD shapes: boundary representations of OpenCASCADE, from files or from the memory of a program. This code
/// does not depend on FreeCAD. Lengths are in millimetres.
namespace collarmesh::brep {

/// The owner of the common part of several solids.
enum class Overlap {
  first,  ///< the first solid in the order of their numbers, or another one that lies wholly inside it
  region  ///< a new region for each set of solids that overlap, numbered after the solids
};

/// Options for reading a shape.
struct CadOptions {
  Overlap overlap = Overlap::first;
};

/// Bounds on how far chords and triangles may deviate from the exact edges and faces.
struct TessellationOptions {
  double deflection = 0;  ///< largest distance from curved edges and faces, absolute; 0: 1e-4 of the diagonal
  double angle = 20;      ///< degrees; largest turn between neighbouring chords and triangles
  std::vector<Tag> finer_faces{};  ///< numbers of faces that get finer triangles
  double finer = 1;                ///< on these faces both bounds are divided by this
};

/// A length, area or volume of the exact shape and of its tessellation.
struct CadMeasure {
  double exact = 0;
  double cut = 0;  ///< measure of the chords or triangles that replace the exact edge or face
};

/// Measures of a shape and of its tessellation. A measure is missing if OpenCASCADE finds no plausible number
/// for it.
struct CadMeasures {
  std::map<Tag, CadMeasure> lengths, areas;        ///< by the numbers of edges and faces
  std::vector<std::optional<CadMeasure>> volumes;  ///< by soup: the volume inside; nothing if it is open
};

/// The solids of a shape, the faces that belong to no solid, and the edges and vertices inside solids that
/// belong to no face. Sub-shapes of each kind are numbered from 1 in the order of TopExp::MapShapes; a face's
/// tag is its number. Solids that touch are changed so that they share faces there. Pieces of faces and edges
/// that are cut for this keep the number of the original; new edges get the next free numbers. The common
/// part of several solids is given to one of them, or to a new region (`CadOptions::overlap`). Edges that
/// belong to no face are split where they meet faces or one another. Their pieces that lie outside the
/// solids, on faces, or too near to faces or to one another are left out; notes list these pieces. A shape of
/// faces alone is sewn and becomes a solid if it is closed; the faces of an open solid are sewn, too.
/// Failures of OpenCASCADE are listed in `notes`, and the builder of the complex must handle them: solids
/// that cannot be fused may intersect, solids that stay open have holes, and a face that cannot be
/// triangulated together with its neighbours may be missing, or may have points along its edges that its
/// neighbours lack. The functions are virtual, so that a program without OpenCASCADE can use a model that the
/// module has made (module.cpp).
class CadModel {
 public:
  /// Makes a model. `labels` are those of the shape's sub-shapes. Throws PlcError for a shape without faces
  /// and edges. The result does not depend on the number of cores.
  CadModel(const TopoDS_Shape& shape, std::string name, const CadOptions& options = {},
           CadLabels labels = {});
  virtual ~CadModel();
  CadModel(CadModel&&) noexcept;
  CadModel& operator=(CadModel&&) noexcept;

  virtual const std::string& name() const;
  virtual double diagonal() const;  ///< Returns the diagonal of the shape's bounding box.
  virtual const CadLabels& labels() const;

  /// Triangulates all faces. Returns one soup for each solid, then, if there are any, one for the faces that
  /// belong to no solid, and one of chords and points for the edges and vertices inside solids that belong to
  /// no face. The number of soups does not depend on the options. Neighbouring faces share the points of
  /// their edges, except for faces that `notes` names. Vertices, edges and faces of the shape are features
  /// with their numbers as tags; seams and degenerate edges are no features. Throws PlcError if OpenCASCADE
  /// fails, or no face can be triangulated.
  virtual std::vector<PolygonSoup> tessellate(const TessellationOptions& options);

  /// Returns the changes to the shape (sewn faces, overlaps, mended faces, ...), as sentences.
  virtual std::vector<std::string> notes() const;

  /// Returns the numbers of faces that were merged (faces of touching solids, or by sewing): pairs of the
  /// number that is gone and the number that replaces it.
  virtual const std::vector<std::pair<Tag, Tag>>& replaced_faces() const;

  /// Returns false if solids that touch or overlap were left unchanged. Their soups may intersect then,
  /// however fine the triangles are.
  virtual bool fused() const;

  /// Returns sentences that say which solids are open, at which edges and where, with a remedy; "" if all are
  /// closed. If no complex can be made of the soups, the error message should contain them.
  virtual const std::string& open_edges_text() const;

  /// Returns the point of EdgeN (dimension 1), or of the surface of FaceN (dimension 2), that is nearest to
  /// `p`. The point `p` must not be much farther from the edge or face than the tessellation is. Returns
  /// nothing if there is no such sub-shape or OpenCASCADE finds no point. Precondition: tessellated. Cost:
  /// constant for planes, lines and other elementary shapes; else linear in the edge's chords, or logarithmic
  /// in the face's triangles.
  virtual std::optional<Point> nearest(unsigned dimension, Tag number, const Point& p) const;

  /// Returns the two faces whose triangles have the corners nearest to a place, as "Face3 and Face7".
  /// Precondition: tessellated.
  virtual std::string faces_near(const Point& where) const;

  /// Returns the distance from a place to the nearest corner of the triangles. Precondition: tessellated.
  virtual double distance_to(const Point& where) const;

  /// Returns lengths, areas and volumes of the exact shape, by integrals, and of its tessellation. Seams have
  /// no lengths. Precondition: tessellated. The first call integrates over all faces, which costs a small
  /// part of reading the shape, and keeps the results. Not for several threads at once.
  virtual CadMeasures measures() const;

  /// Returns text on the first few sub-shapes that OpenCASCADE's own check finds invalid, with places; "" if
  /// there are none or the check fails. Names only sub-shapes of the lowest dimension at which it finds any,
  /// because shapes that contain invalid ones are invalid, too.
  virtual std::string invalid_parts() const;

  struct Parts;
  const Parts& parts() const { return *parts_; }

 private:
  std::unique_ptr<Parts> parts_;
};

/// Reads a file. Its format is `format` or, if that is empty, the path's extension (any case): .brep .brp
/// (OpenCASCADE), .step .stp, .iges .igs; the units of STEP and IGES become millimetres. Throws ReadError,
/// and PlcError as the constructor does.
CadModel read_cad(const std::string& path, std::string_view format = {}, const CadOptions& options = {});

}  // namespace collarmesh::brep
