// Reads VTK's legacy format for unstructured grids, versions 1 to 5.1, text and binary: tetrahedra, prisms,
// pyramids, triangles, quadrangles and lines with their labels; skips other data.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include "collarmesh/error.h"
#include "io/file_bytes.h"
#include "io/finite_points.h"
#include "io/label_names.h"
#include "io/number_text.h"
#include "io/tet_mesh_formats.h"
#include "io/text_scanner.h"
#include "io/vtk_array.h"
#include "io/vtk_grid.h"

namespace collarmesh::io {

namespace {

struct LegacyType {
  std::string_view name;
  NumberType type;
};
/// VTK writes vtkIdType with 32 bits in this format. "long" has 64 bits, as on the systems where most VTK
/// files come from.
constexpr LegacyType legacy_types[] = {{"char", NumberType::i8},
                                       {"signed_char", NumberType::i8},
                                       {"unsigned_char", NumberType::u8},
                                       {"short", NumberType::i16},
                                       {"unsigned_short", NumberType::u16},
                                       {"int", NumberType::i32},
                                       {"unsigned_int", NumberType::u32},
                                       {"long", NumberType::i64},
                                       {"unsigned_long", NumberType::u64},
                                       {"vtktypeint64", NumberType::i64},
                                       {"vtktypeuint64", NumberType::u64},
                                       {"vtkidtype", NumberType::i32},
                                       {"float", NumberType::f32},
                                       {"double", NumberType::f64}};

class LegacyReader {
 public:
  LegacyReader(const std::string& path, std::string_view text) : path_(path), scan_(path, text, 0) {}

  TetMesh read() {
    read_head();
    while (!scan_.at_end()) read_section();
    if (piece_.types.size() != piece_.ends.size())
      fail(fmt::format("expected the types of {} cells, found {}", piece_.ends.size(), piece_.types.size()));
    TetMesh mesh;
    try {
      add_vtk_piece(piece_, mesh);
    } catch (const VtkPieceError& error) {
      fail(error.message);
    }
    if (mesh.tets.empty()) fail("expected tetrahedra, found none");
    complete_vtk_mesh(path_, mesh);
    return mesh;
  }

 private:
  void read_head() {
    constexpr std::string_view magic = "# vtk DataFile Version";
    const std::string_view first = scan_.rest_of_line();
    if (!first.starts_with(magic)) fail(fmt::format("expected '{}', found {}", magic, in_quotes(first)));
    version_at_least_5_ = first.substr(magic.size()).find_first_of("56789") == 1;
    scan_.rest_of_line();  // the title
    const std::string encoding = keyword("ASCII or BINARY");
    if (encoding != "ascii" && encoding != "binary") scan_.fail("ASCII or BINARY", encoding);
    binary_ = encoding == "binary";
  }

  void read_section() {
    const std::string name = keyword("a section such as POINTS");
    if (name == "dataset")
      read_dataset();
    else if (name == "points")
      read_points();
    else if (name == "cells")
      read_cells();
    else if (name == "cell_types")
      piece_.types = values<std::int64_t>(scan_.count("the number of cells", 1), NumberType::i32);
    else if (name == "cell_data")
      begin_data(scan_.count("the number of cells", 1), piece_.ends.size(), piece_.cell_data,
                 vtk_cell_arrays);
    else if (name == "point_data")
      begin_data(scan_.count("the number of points", 1), piece_.points.size(), piece_.point_data,
                 vtk_point_arrays);
    else if (name == "metadata")
      skip_metadata();
    else if (!read_attribute(name))
      scan_.fail("a section such as POINTS, CELLS or CELL_DATA", name);
  }

  void read_dataset() {
    const std::string kind = keyword("UNSTRUCTURED_GRID");
    if (kind != "unstructured_grid")
      fail(fmt::format("the dataset is {}, but has to be UNSTRUCTURED_GRID", in_quotes(kind)));
  }

  /// Rejects a section of points or cells that comes after their data.
  void require_no_data(const VtkPiece::Arrays& arrays, std::string_view section) const {
    if (!arrays.empty()) fail(fmt::format("{} come after their data, but must come before", section));
  }

  void read_points() {
    require_no_data(piece_.point_data, "POINTS");
    const Index n = scan_.count("the number of points", 3);
    piece_.points = finite_points(values<double>(3 * std::size_t{n}, read_type()),
                                  [this](const std::string& message) { fail(message); });
  }

  void read_cells() {
    require_no_data(piece_.cell_data, "CELLS");
    const Index n = scan_.count("the number of cells", 2), size = scan_.count("the size of the cells", 2);
    if (version_at_least_5_)
      read_offsets_and_connectivity(n, size);
    else
      read_counted_cells(n, size);
  }

  void read_offsets_and_connectivity(Index n, Index size) {
    if (keyword("OFFSETS") != "offsets") fail("expected OFFSETS");
    std::vector<std::int64_t> offsets = values<std::int64_t>(n, read_type());
    if (keyword("CONNECTIVITY") != "connectivity") fail("expected CONNECTIVITY");
    piece_.connectivity = values<std::int64_t>(size, read_type());
    if (!offsets.empty() && offsets.front() != 0) fail("the first cell has to begin at 0");
    if (!offsets.empty()) offsets.erase(offsets.begin());
    piece_.ends = std::move(offsets);
  }

  void read_counted_cells(Index n, Index size) {
    const std::vector<std::int64_t> numbers = values<std::int64_t>(size, NumberType::i32);
    piece_.connectivity.clear();
    piece_.ends.clear();
    std::size_t at = 0;
    for (Index i = 0; i < n; ++i) {
      const std::int64_t count = at < numbers.size() ? numbers[at++] : -1;
      if (count < 0 || static_cast<std::size_t>(count) > numbers.size() - at)
        fail(fmt::format("cell {} of {} reaches beyond the {} integers of the section CELLS", i, n, size));
      const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(at);
      piece_.connectivity.insert(piece_.connectivity.end(), first, first + count);
      piece_.ends.push_back(static_cast<std::int64_t>(piece_.connectivity.size()));
      at += static_cast<std::size_t>(count);
    }
    if (at != numbers.size())
      fail(fmt::format("the {} cells have {} numbers, not {} as the section CELLS announces", n, at, size));
  }

  template <std::size_t count>
  void begin_data(std::size_t tuples, std::size_t expected, VtkPiece::Arrays& arrays,
                  const std::array<std::string_view, count>& wanted) {
    if (tuples != expected)
      fail(fmt::format("expected data for {} points or cells, found data for {}", expected, tuples));
    tuples_ = tuples;
    arrays_ = &arrays;
    wanted_ = wanted;
  }

  /// Reads an attribute with this keyword. Returns false if it is no keyword of an attribute.
  bool read_attribute(const std::string& name) {
    if (name == "scalars")
      read_scalars();
    else if (name == "lookup_table")
      read_table();
    else if (name == "field")
      read_field();
    else if (name == "vectors" || name == "normals")
      skip_array(3);
    else if (name == "tensors")
      skip_array(9);
    else if (name == "tensors6")
      skip_array(6);
    else if (name == "global_ids" || name == "pedigree_ids")
      skip_array(1);
    else if (name == "texture_coordinates")
      skip_texture();
    else if (name == "color_scalars")
      skip_colors();
    else
      return false;
    return true;
  }

  void read_scalars() {
    const std::string_view name = scan_.word("the name of an array");
    const NumberType type = read_type(false);
    const Index components = scan_.at_line_end() ? 1 : scan_.count("the number of components", 1);
    if (lower_case(scan_.peek()) == "lookup_table") {
      scan_.word("LOOKUP_TABLE");
      scan_.word("the name of a table");
    }
    keep(name, components, values<std::int64_t>(times(tuples_, components), type));
  }

  void read_table() {
    scan_.word("the name of a table");
    const Index n = scan_.count("the size of a table", 1);
    values<double>(4 * std::size_t{n}, binary_ ? NumberType::u8 : NumberType::f32);
  }

  void read_field() {
    scan_.word("the name of a field");
    const Index arrays = scan_.count("the number of arrays", 1);
    for (Index i = 0; i < arrays; ++i) {
      std::string_view name = scan_.word("the name of an array");
      while (lower_case(name) == "metadata") {
        skip_metadata();
        name = scan_.word("the name of an array");
      }
      const Index components = scan_.count("the number of components", 1),
                  tuples = scan_.count("the number of tuples", 1);
      std::vector<std::int64_t> numbers = values<std::int64_t>(times(tuples, components), read_type());
      if (arrays_ == nullptr && name == vtk_names)
        piece_.names = names_of(numbers);
      else if (tuples == tuples_)
        keep(name, components, std::move(numbers));
    }
  }

  void keep(std::string_view name, Index components, std::vector<std::int64_t> numbers) {
    if (arrays_ == nullptr || components != 1) return;
    if (std::find(wanted_.begin(), wanted_.end(), name) != wanted_.end())
      arrays_->insert_or_assign(std::string(name), std::move(numbers));
  }

  void skip_array(std::size_t components) {
    scan_.word("the name of an array");
    values<double>(times(tuples_, components), read_type());
  }

  void skip_texture() {
    scan_.word("the name of an array");
    const Index dimension = scan_.count("the dimension of texture coordinates", 1);
    values<double>(times(tuples_, dimension), read_type());
  }

  void skip_colors() {
    scan_.word("the name of an array");
    const Index components = scan_.count("the number of components", 1);
    values<double>(times(tuples_, components), binary_ ? NumberType::u8 : NumberType::f32);
  }

  /// Skips metadata, which ends with an empty line.
  void skip_metadata() {
    scan_.skip_line();
    while (scan_.left() > 0 && !scan_.rest_of_line().empty()) {
    }
  }

  std::size_t times(std::size_t a, std::size_t b) const {
    if (b > 0 && a > scan_.left() / b + 1)
      fail(fmt::format("{} times {} values do not fit into the {} bytes that follow", a, b, scan_.left()));
    return a * b;
  }

  NumberType read_type(bool last_on_line = true) {
    const std::string name = keyword("a type of values");
    const auto* found = std::find_if(std::begin(legacy_types), std::end(legacy_types),
                                     [&](const LegacyType& known) { return known.name == name; });
    if (found == std::end(legacy_types)) scan_.fail("a type such as int or double", name);
    if (last_on_line && !scan_.at_line_end()) scan_.fail("the end of the line", scan_.peek());
    return found->type;
  }

  /// Reads `count` numbers, which begin on the next line if they are binary.
  template <class T>
  std::vector<T> values(std::size_t count, NumberType type) {
    if (binary_) return binary_values<T>(count, type);
    if (count > scan_.left() / 2 + 1)
      fail(fmt::format("expected {} values, found only {} bytes; the file is cut off", count, scan_.left()));
    std::vector<T> result;
    result.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
      if constexpr (std::is_integral_v<T>)
        result.push_back(type == NumberType::f32 || type == NumberType::f64 ? rounded(scan_.number("a value"))
                                                                            : scan_.integer("a value"));
      else
        result.push_back(scan_.number("a value"));
    return result;
  }

  std::int64_t rounded(double value) const {
    if (!(std::fabs(value) < 0x1p62))
      fail(fmt::format("the value {} is not a number, or too large for a 64-bit integer", value));
    return std::llround(value);
  }

  template <class T>
  std::vector<T> binary_values(std::size_t count, NumberType type) {
    scan_.skip_line();
    const std::size_t size = size_of(type);
    if (count > scan_.left() / size)
      fail(fmt::format("expected {} values of {} bytes, found {} bytes; the file is cut off", count, size,
                       scan_.left()));
    return convert_vtk_values<T>(scan_.raw(count * size), type, std::endian::big);
  }

  std::string keyword(std::string_view what) { return lower_case(scan_.word(what)); }

  /// Throws ReadError with the line or, in a binary file, the byte.
  [[noreturn]] void fail(const std::string& message) const {
    if (!binary_) scan_.fail(message);
    throw ReadError(fmt::format("{}: byte {}: {}", path_, scan_.offset(), message));
  }

  const std::string& path_;
  TextScanner scan_;
  bool binary_ = false, version_at_least_5_ = false;
  VtkPiece piece_;
  std::size_t tuples_ = 0;
  VtkPiece::Arrays* arrays_ = nullptr;
  std::span<const std::string_view> wanted_;
};

}  // namespace

TetMesh read_vtk(const std::string& path) {
  const std::string text = read_bytes(path);
  return LegacyReader(path, text).read();
}

}  // namespace collarmesh::io
