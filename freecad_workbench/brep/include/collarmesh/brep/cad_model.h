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

/// CAD shapes: boundary representations of OpenCASCADE, as FreeCAD has them. Lengths are millimetres.
namespace collarmesh::brep {

/// Whose is what several solids have in common?
enum class Overlap {
  first,  ///< the first one's, in the order of their numbers; or that of one which lies wholly inside the
          ///< first
  region  ///< a region of its own, one for each set of solids, numbered after the solids
};

/// How a shape is read.
struct CadOptions {
  Overlap overlap = Overlap::first;
};

/// How near the triangles come to the faces.
struct TessellationOptions {
  double deflection = 0;  ///< largest distance from curved edges and faces, absolute; 0: 1e-4 of the diagonal
  double angle = 20;      ///< degrees that neighbouring chords and triangles turn at most
  std::vector<Tag> finer_faces{};  ///< numbers of faces that are cut more finely
  double finer = 1;                ///< by this, in both
};

/// A length, area or volume.
struct CadMeasure {
  double exact = 0;
  double cut = 0;  ///< of the chords or triangles in its place
};

/// Measures of a shape and of its tessellation. A measure that OpenCASCADE finds no plausible number for is
/// not there.
struct CadMeasures {
  std::map<Tag, CadMeasure> lengths, areas;        ///< by the numbers of edges and faces
  std::vector<std::optional<CadMeasure>> volumes;  ///< of what each soup bounds
};

/// The solids of a shape, with the faces that belong to none, and the edges and vertices inside that belong
/// to no face. Its sub-shapes have the numbers FreeCAD gives them (the order of TopExp::MapShapes): FaceN has
/// the tag N.
///
/// Solids that touch are made to share the faces there; faces and edges that are cut in this keep the
/// number of what they were part of, edges that arise get the next free ones. What solids have in common is
/// given to one of them. Edges of no face are cut where they meet faces or one another, and are left out
/// outside of the solids, on their faces, and too near to these or to one another; notes tell of these. A
/// shape of faces alone is sewn and becomes a solid where it is closed; so are the faces of an open solid.
///
/// What OpenCASCADE cannot do is left to whoever makes a complex of the soups, and told in `notes`: solids
/// that it cannot fuse may intersect, solids that stay open have holes, and a face that it cannot cut into
/// triangles may have points along its edges that its neighbours lack, or may be missing.
///
/// What it can do is virtual, so that a program without OpenCASCADE can use one that the module has made
/// (module.cpp).
class CadModel {
 public:
  /// `labels`: of the shape's sub-shapes. Throws PlcError for a shape without solids, faces and edges. The
  /// result does not depend on the number of cores.
  CadModel(const TopoDS_Shape& shape, std::string name, const CadOptions& options = {},
           CadLabels labels = {});
  virtual ~CadModel();
  CadModel(CadModel&&) noexcept;
  CadModel& operator=(CadModel&&) noexcept;

  virtual const std::string& name() const;
  virtual double diagonal() const;  ///< of the box around it
  virtual const CadLabels& labels() const;

  /// Triangles of all faces: one soup for each solid, one for the faces that belong to none, and one of
  /// chords and points for the edges and vertices inside a solid that belong to no face. As many, whatever
  /// the options.
  /// Neighbouring faces share the points of their edges. Vertices, edges and faces of the shape are
  /// features with their numbers as tags; seams and degenerate edges are none.
  /// Throws PlcError when OpenCASCADE fails, or no face can be cut into triangles.
  virtual std::vector<PolygonSoup> tessellate(const TessellationOptions& options);

  /// What was done to the shape (faces sewn, overlaps, faces that were mended, ...), for people.
  virtual std::vector<std::string> notes() const;

  /// Where faces of solids that touch or were sewn became one: the number that is gone and the one in its
  /// place.
  virtual const std::vector<std::pair<Tag, Tag>>& replaced_faces() const;

  /// False: solids that touch or overlap were left as they are, so their soups intersect, however fine.
  virtual bool fused() const;

  /// Which solids are open, at which edges and where, and what to do; empty when all are closed. For the
  /// message when no complex can be made of the soups.
  virtual const std::string& open_edges_text() const;

  /// The nearest point of EdgeN (dimension 1), or of the surface of FaceN (dimension 2), to a point that is
  /// about as near to it as the tessellation; nothing where there is no such sub-shape or OpenCASCADE finds
  /// no point. Precondition: tessellated.
  /// Cost: constant for simple surfaces, logarithmic in the face's triangles for others.
  virtual std::optional<Point> nearest(unsigned dimension, Tag number, const Point& p) const;

  /// The faces nearest to a place, as "Face3 and Face7". Precondition: tessellated.
  virtual std::string faces_near(const Point& where) const;

  /// From a place to the nearest point of the triangles. Precondition: tessellated.
  virtual double distance_to(const Point& where) const;

  /// Lengths, areas and volumes, by integrals over the exact edges and faces; of seams there are none.
  /// Precondition: tessellated. Cost: a small part of reading the shape.
  virtual CadMeasures measures() const;

  /// The sub-shapes that OpenCASCADE's own check finds invalid, with places; empty: none.
  virtual std::string invalid_parts() const;

  struct Parts;
  const Parts& parts() const { return *parts_; }

 private:
  std::unique_ptr<Parts> parts_;
};

/// Read a file by its extension (any case) or as `format` says: .brep .brp (OpenCASCADE), .step .stp,
/// .iges .igs; the units of STEP and IGES become millimetres.
/// Throws ReadError, and PlcError as the constructor does.
CadModel read_cad(const std::string& path, std::string_view format = {}, const CadOptions& options = {});

}  // namespace collarmesh::brep
