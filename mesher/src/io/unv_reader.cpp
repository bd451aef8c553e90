// Reads the universal file format of I-DEAS (.unv): nodes (2411, 781), elements (2412, 780) and groups (2467
// and seven related datasets). Groups become tags: a group with a name of ours becomes the tag that the name
// stands for, others are numbered in their order and keep their names. Without groups the materials become
// tags.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "collarmesh/error.h"
#include "io/cell_nodes.h"
#include "io/complete_mesh.h"
#include "io/file_bytes.h"
#include "io/label_names.h"
#include "io/number_table.h"
#include "io/number_text.h"
#include "io/tet_mesh_formats.h"
#include "io/text_scanner.h"
#include "io/unv_format.h"

namespace collarmesh::io {

namespace {

class UnvReader {
 public:
  UnvReader(const std::string& path, std::string_view text) : path_(path), scan_(path, text, 0) {}

  TetMesh read() {
    if (scan_.peek() != "-1") scan_.fail("-1, the beginning of a dataset", scan_.peek());
    while (!scan_.at_end()) {
      if (const std::string_view mark = scan_.word("-1"); mark != "-1")
        scan_.fail("-1, the beginning of a dataset", mark);
      read_dataset(scan_.integer("the number of a dataset"));
      if (const std::string_view mark = scan_.word("-1"); mark != "-1")
        scan_.fail("-1, the end of a dataset", mark);
    }
    if (mesh_.tets.empty() && mesh_.faces.empty() && mesh_.edges.empty())
      scan_.fail("expected tetrahedra (111, 118), found none");
    tag_cells();
    complete_mesh(path_, mesh_);
    return std::move(mesh_);
  }

 private:
  void read_dataset(std::int64_t number) {
    scan_.skip_line();
    // Members of the older datasets have no node and component.
    constexpr std::array<std::int64_t, 4> old_groups{2417, 2429, 2430, 2432},
        groups{2435, 2452, unv_groups, 2477};
    const auto is_one_of = [number](const std::array<std::int64_t, 4>& numbers) {
      return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
    };
    if (number == unv_nodes || number == 781)
      read_nodes();
    else if (number == unv_elements || number == 780)
      read_elements(number == 780);
    else if (is_one_of(old_groups) || is_one_of(groups))
      read_groups(is_one_of(groups));
    else
      skip_dataset();
  }

  bool at_mark() { return scan_.at_end() || scan_.peek() == "-1"; }

  /// Skips a dataset. Its texts may hold anything; only a line of "-1" ends it.
  void skip_dataset() {
    while (!at_mark()) scan_.skip_line();
  }

  double real() {
    std::string text(scan_.word("a coordinate of a node"));
    for (char& c : text)
      if (c == 'D' || c == 'd') c = 'E';
    double value = 0;
    if (!parse(text, value) || !std::isfinite(value))
      scan_.fail("a coordinate of a node, a finite number", text);
    return value;
  }

  void read_nodes() {
    while (!at_mark()) {
      node_numbers_.add(scan_.integer("the number of a node"));
      scan_.skip_line();
      const double x = real(), y = real(), z = real();
      mesh_.points.push_back({x, y, z});
    }
    if (const auto twice = node_numbers_.sort())
      scan_.fail(fmt::format("two nodes have the number {}", *twice));
  }

  void read_elements(bool old) {
    while (!at_mark()) {
      const std::int64_t number = scan_.integer("the number of an element"),
                         type = scan_.integer("the type of an element");
      // The element's property and material follow (two numbers each in dataset 780), then colour and number
      // of nodes.
      scan_.integer("a property");
      if (old) scan_.integer("a property");
      const std::int64_t material = scan_.integer("a material");
      if (old) scan_.integer("a material");
      scan_.integer("a colour");
      const Index nodes = scan_.count("the number of nodes", 2);
      if (unv_is_beam(static_cast<int>(type)) || (type == unv_rod && words_on_next_line() == 3)) {
        scan_.skip_line();
        scan_.skip_line();
      }
      read_element(number, type, nodes, material);
    }
  }

  /// Returns the number of words on the next line. SALOME and FreeCAD write the beams' record of three
  /// numbers for rods, too, before the line with a rod's two nodes.
  std::size_t words_on_next_line() const {
    TextScanner ahead = scan_;
    ahead.skip_line();
    std::size_t words = 0;
    for (; !ahead.at_line_end(); ++words) ahead.word("a number");
    return words;
  }

  void read_element(std::int64_t number, std::int64_t type, Index count, std::int64_t material) {
    const auto* known =
        std::find_if(unv_types.begin(), unv_types.end(), [&](const UnvType& t) { return t.number == type; });
    if (known == unv_types.end() || known->nodes != count)
      scan_.fail(fmt::format(
          "elements of type {} with {} nodes are not supported, only tetrahedra (111, 118), prisms "
          "(112, 113), triangles (91, 92, 41, 42), quadrangles (94, 95, 44, 45) and lines (21, 24, "
          "11)",
          type, count));
    std::array<Index, 20> listed{};
    for (std::size_t k = 0; k < count; ++k) listed[k] = read_node();
    const std::optional<CellNodes> nodes =
        CellNodes::gathered(std::span(listed).first(count), known->node_order());
    if (!nodes)
      scan_.fail(fmt::format(
          "element {} is a brick, which is not supported, unless its upper nodes are the same", number));
    add_cell(known->kind, *nodes, mesh_);
    element_numbers_.add(number);
    elements_.push_back({known->kind, material, 0, false});
  }

  Index read_node() {
    const std::int64_t number = scan_.integer("a node of an element");
    const Index node = node_numbers_.find(number);
    if (node == none)
      scan_.fail(fmt::format("an element has the node {}, but no node before has that number", number));
    return node;
  }

  /// Reads groups. `long_members`: whether each member has type, number, node and component, not only type
  /// and number.
  void read_groups(bool long_members) {
    while (!at_mark()) {
      scan_.integer("the number of a group");
      for (int k = 0; k < 6; ++k) scan_.integer("a number of a group");
      const Index members = scan_.count("the number of members", 4);
      scan_.skip_line();
      const std::string name(scan_.rest_of_line());
      for (Index i = 0; i < members; ++i) {
        const std::int64_t type = scan_.integer("the type of a member"),
                           number = scan_.integer("the number of a member");
        if (long_members) {
          scan_.integer("a node");
          scan_.integer("a component");
        }
        if (type == unv_group_element) members_.push_back({name_index(name), number});
      }
    }
  }

  struct Member {
    std::size_t group;
    std::int64_t element;
  };
  struct Element {
    CellKind kind;
    std::int64_t material;
    Tag tag;
    bool tagged;

    std::size_t dimension() const { return shape_of(kind).dimension; }
  };

  std::size_t name_index(const std::string& name) {
    if (names_.empty() || names_.back() != name) names_.push_back(name);
    return names_.size() - 1;
  }

  /// Sets the tag of each element: that of the first group that contains it or, in a file without groups, its
  /// material. Materials also become regions if they can be region numbers.
  void tag_cells() {
    if (const auto twice = element_numbers_.sort())
      scan_.fail(fmt::format("two elements have the number {}", *twice));
    GroupTags tags;
    for (const auto& [group, number] : members_) {
      const Index found = element_numbers_.find(number);
      if (found == none || elements_[found].tagged) continue;
      Element& element = elements_[found];
      element.tagged = true;
      element.tag = tags.find(element.dimension(), names_[group]);
      if (names_[group] != group_name(GroupNames::complex, element.dimension(), element.tag))
        mesh_.names.set(element.dimension(), element.tag, names_[group]);
    }
    bool by_material = true;
    for (const Element& element : elements_) {
      tags_of(mesh_, element.kind).push_back(members_.empty() ? element.material : element.tag);
      if (element.dimension() == 3)
        by_material = by_material && element.material > 0 && element.material < none;
    }
    if (!by_material) return;
    for (const Element& element : elements_)
      if (element.dimension() == 3)
        features_of(mesh_, element.kind).push_back(static_cast<Index>(element.material));
  }

  const std::string& path_;
  TextScanner scan_;
  TetMesh mesh_;
  NumberTable node_numbers_, element_numbers_;
  std::vector<Element> elements_;
  std::vector<std::string> names_;
  std::vector<Member> members_;
};

}  // namespace

TetMesh read_unv(const std::string& path) {
  const std::string text = read_bytes(path);
  return UnvReader(path, text).read();
}

}  // namespace collarmesh::io
