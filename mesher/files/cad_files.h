#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/options.h"
#include "collarmesh/polygon_soup.h"

namespace collarmesh::brep {
struct CadLabels;
struct CadMeasures;
}  // namespace collarmesh::brep

namespace collarmesh::files {

/// Options for reading CAD files.
struct CadReading {
  std::function<double(double diagonal)> deflection;  ///< returns the permitted distance of triangles from
                                                      ///< the shape, absolute, given the shape's diagonal
  SolidOverlap overlap = SolidOverlap::first;
  unsigned threads = 0;  ///< maximum number; 0: all cores
};

/// Tells the process's supervisor which work of OpenCASCADE on a file begins, and how many seconds it may
/// take (0: no limit). The work ends when the returned object is destroyed.
using CadGuard =
    std::function<std::shared_ptr<void>(std::string_view doing, std::string_view file, double seconds)>;

/// The CAD files among the inputs. Reading the first one loads the module with OpenCASCADE.
class CadFiles {
 public:
  explicit CadFiles(CadGuard guard = {});
  ~CadFiles();
  CadFiles(CadFiles&&) noexcept;
  CadFiles& operator=(CadFiles&&) noexcept;

  static std::vector<std::string> formats();
  /// Returns whether a file is a CAD file, by its extension or by `format`.
  static bool knows(const std::string& path, std::string_view format);

  /// Reads a file and appends its soups. Throws ReadError and PlcError.
  void read(const std::string& path, std::string_view format, const CadReading& reading,
            std::vector<PolygonSoup>& soups);
  bool empty() const;
  /// Returns the names of the files, for messages.
  std::string names() const;
  /// Returns names and colours of the CAD file if all soups of the complex came from it (`soups` is their
  /// number); else null, because the tags of several files would collide.
  const brep::CadLabels* labels(std::size_t soups) const;

  /// Replaces the soups' triangles by finer ones: the permitted distance and angle between them and the shape
  /// are those of the first triangles divided by `finer`.
  void tessellate(double finer, std::vector<PolygonSoup>& soups);
  /// Does the same for some faces only; the other faces of their files get their first triangles again. A
  /// face is given by the number of its soup and its tag.
  void tessellate(double finer, const std::set<std::pair<Index, Tag>>& faces,
                  std::vector<PolygonSoup>& soups);

  /// Returns the nearest point of EdgeN (dimension 1) or FaceN (2), where N is `number`, of the file that a
  /// soup came from; nothing if that is no CAD file.
  std::optional<Point> nearest(Index soup, unsigned dimension, Tag number, const Point& p) const;

  /// Exact lengths, areas and volumes of the shape in a CAD file, and the file's first soup.
  struct Measured {
    const brep::CadMeasures& measures;
    Index first_soup;
  };
  /// Returns the measures of the file that a soup came from; nothing if that is no CAD file.
  std::optional<Measured> measures(Index soup) const;

  /// Returns the faces nearest to a place, in the file whose faces are nearest: "Face3 and Face7 of
  /// part.step".
  std::string faces_near(const Point& where) const;
  /// Returns the sub-shapes that OpenCASCADE finds invalid, or empty.
  std::string invalid_parts() const;
  /// Returns faces that were merged with others: pairs of the number that is gone and the number that
  /// replaces it.
  std::vector<std::pair<Tag, Tag>> replaced_faces() const;
  /// Returns whether a soup came from a CAD file.
  bool has(Index soup) const { return file_of(soup) != nullptr; }
  /// Returns false if solids that touch or overlap could not be fused. Their soups then intersect, even with
  /// fine triangles.
  bool fused() const;
  /// Returns a text that says which solids are open, at which edges and where; empty if none is.
  std::string open_edges() const;
  /// Returns notes on the shapes. With `of_solids`, includes notes on open solids.
  std::vector<std::string> notes(bool of_solids) const;

 private:
  struct File;
  const File* file_of(Index soup) const;

  std::shared_ptr<void> guarded(std::string_view doing, std::string_view file, double seconds = 0) const {
    return guard_ ? guard_(doing, file, seconds) : nullptr;
  }

  CadGuard guard_;
  std::vector<File> files_;
};

}  // namespace collarmesh::files
