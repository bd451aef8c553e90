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

/// Options of reading CAD files.
struct CadReading {
  std::function<double(double diagonal)>
      deflection;  ///< distance of the triangles, absolute, from the shape's diagonal
  SolidOverlap overlap = SolidOverlap::first;
  unsigned threads = 0;  ///< maximum number; 0: all cores
};

/// Tells the process's supervisor what OpenCASCADE is about to do to a file, and how many seconds it may take
/// (0: any time). The work is over when the returned object is destroyed.
using CadGuard =
    std::function<std::shared_ptr<void>(std::string_view doing, std::string_view file, double seconds)>;

/// The CAD files among the inputs. The first one loads the module with OpenCASCADE.
class CadFiles {
 public:
  explicit CadFiles(CadGuard guard = {});
  ~CadFiles();
  CadFiles(CadFiles&&) noexcept;
  CadFiles& operator=(CadFiles&&) noexcept;

  static std::vector<std::string> formats();
  /// Returns whether it is a CAD file, by its extension or by `format`.
  static bool knows(const std::string& path, std::string_view format);

  /// Reads a file and appends its soups. Throws ReadError and PlcError.
  void read(const std::string& path, std::string_view format, const CadReading& reading,
            std::vector<PolygonSoup>& soups);
  bool empty() const;
  /// Returns the names of the files, for people.
  std::string names() const;
  /// Returns names and colours of the file that all these soups came from; null if they came from several
  /// files, whose numbers would collide.
  const brep::CadLabels* labels(std::size_t soups) const;

  /// Replaces the soups' triangles by triangles that are finer than the first ones by a factor.
  void tessellate(double finer, std::vector<PolygonSoup>& soups);
  /// Does the same for some faces, given by the number of their soup and their own.
  void tessellate(double finer, const std::set<std::pair<Index, Tag>>& faces,
                  std::vector<PolygonSoup>& soups);

  /// Returns the nearest point of EdgeN (dimension 1) or FaceN (2) of the file that a soup came from; nothing
  /// for soups of other files.
  std::optional<Point> nearest(Index soup, unsigned dimension, Tag number, const Point& p) const;

  /// Exact lengths, areas and volumes of the shape in the file that a soup came from, and the first soup of
  /// that file; nothing for soups of other files.
  struct Measured {
    const brep::CadMeasures& measures;
    Index first_soup;
  };
  std::optional<Measured> measures(Index soup) const;

  /// Returns the faces nearest to a place, in the file whose faces are nearest: "Face3 and Face7 of
  /// part.step".
  std::string faces_near(const Point& where) const;
  /// Returns the sub-shapes that OpenCASCADE finds invalid, or empty.
  std::string invalid_parts() const;
  /// Returns faces that were merged with others: the number that is gone and the one in its place.
  std::vector<std::pair<Tag, Tag>> replaced_faces() const;
  /// Returns false if solids that touch or overlap could not be fused; their soups then intersect, however
  /// fine.
  bool fused() const;
  /// Returns which solids are open, at which edges and where; or empty.
  std::string open_edges() const;
  /// Returns notes on the shapes; `of_solids` adds those on open solids.
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
