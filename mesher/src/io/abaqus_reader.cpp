// Reads the input format of Abaqus and CalculiX (.inp): tetrahedra, prisms and pyramids of solids (C3D4,
// C3D10, C3D6 and their variants), triangles, quadrangles and lines of shells, membranes, beams and trusses,
// and surfaces of element sides. Element sets and surfaces become tags: if the name is one that we write, the
// tag in it, otherwise a number by their order in the file.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "io/abaqus_format.h"
#include "io/abaqus_pyramids.h"
#include "io/cell_nodes.h"
#include "io/cell_orientation.h"
#include "io/complete_mesh.h"
#include "io/file_bytes.h"
#include "io/label_names.h"
#include "io/number_table.h"
#include "io/number_text.h"
#include "io/tet_mesh_formats.h"
#include "io/text_scanner.h"

namespace collarmesh::io {

namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\f\v";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Splits a line at commas into fields; a comma at the end adds no empty field.
void split(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  while (!line.empty()) {
    const std::size_t comma = std::min(line.find(','), line.size());
    fields.push_back(trimmed(line.substr(0, comma)));
    line.remove_prefix(std::min(comma + 1, line.size()));
  }
}

/// The lines of a file without comments and empty lines.
class Lines {
 public:
  Lines(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  /// Sets `line` to the next line, but does not go past it: `next` does. Returns false at the end.
  bool peek(std::string_view& line) {
    while (at_ < text_.size()) {
      end_ = std::min(text_.find('\n', at_), text_.size());
      line = trimmed(text_.substr(at_, end_ - at_));
      if (!line.empty() && !line.starts_with("**")) return true;
      next();
    }
    return false;
  }
  void next() {
    at_ = std::min(end_ + 1, text_.size());
    ++line_;
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw ReadError(fmt::format("{}: line {}: {}", path_, line_, message));
  }

 private:
  const std::string& path_;
  std::string_view text_;
  std::size_t at_ = 0, end_ = 0, line_ = 1;
};

/// A keyword line such as "*ELEMENT, TYPE=C3D4": in lower case, with blanks inside names kept.
struct Keyword {
  std::string name;
  std::map<std::string, std::string, std::less<>> parameters;
  std::string set;  ///< the name of the set or surface that the line begins, as written

  explicit Keyword(std::string_view line) {
    std::vector<std::string_view> fields;
    split(line.substr(1), fields);
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const std::size_t equals = std::min(fields[k].find('='), fields[k].size());
      const std::string key = lower_case(trimmed(fields[k].substr(0, equals)));
      const std::string_view value = trimmed(fields[k].substr(std::min(equals + 1, fields[k].size())));
      if (key == "elset" || key == "name") set = value;
      if (k == 0)
        name = key;
      else
        parameters.emplace(key, lower_case(value));
    }
  }
  std::string_view operator[](std::string_view key) const {
    const auto found = parameters.find(key);
    return found == parameters.end() ? std::string_view() : std::string_view(found->second);
  }
};

/// A type of elements. Hexahedra are accepted only as pyramids with coinciding nodes
/// (`abaqus_pyramid_order`).
struct ElementType {
  std::string_view prefix;
  CellKind kind;
  int order;

  bool is_hexahedron() const { return prefix.ends_with("3d8"); }
  std::size_t nodes() const {
    return is_hexahedron() ? abaqus_pyramid_order.size() : shape_of(kind).nodes(order);
  }
};
/// The longest matching prefix determines the type; no digit may follow it: c3d10m is a c3d10, but c3d40 is
/// no c3d4.
constexpr ElementType element_types[] = {
    {"c3d4", CellKind::tet, 1},          {"c3d10", CellKind::tet, 2},
    {"dc3d4", CellKind::tet, 1},         {"dc3d10", CellKind::tet, 2},
    {"f3d4", CellKind::tet, 1},          {"ac3d4", CellKind::tet, 1},
    {"ac3d10", CellKind::tet, 2},        {"c3d6", CellKind::prism, 1},
    {"c3d15", CellKind::prism, 2},       {"dc3d6", CellKind::prism, 1},
    {"dc3d15", CellKind::prism, 2},      {"f3d6", CellKind::prism, 1},
    {"ac3d6", CellKind::prism, 1},       {"ac3d15", CellKind::prism, 2},
    {"c3d5", CellKind::pyramid, 1},      {"c3d8", CellKind::pyramid, 1},
    {"dc3d8", CellKind::pyramid, 1},     {"f3d8", CellKind::pyramid, 1},
    {"ac3d8", CellKind::pyramid, 1},     {"cps3", CellKind::triangle, 1},
    {"cps6", CellKind::triangle, 2},     {"cpe3", CellKind::triangle, 1},
    {"cpe6", CellKind::triangle, 2},     {"cax3", CellKind::triangle, 1},
    {"cax6", CellKind::triangle, 2},     {"s3", CellKind::triangle, 1},
    {"s6", CellKind::triangle, 2},       {"stri3", CellKind::triangle, 1},
    {"stri65", CellKind::triangle, 2},   {"m3d3", CellKind::triangle, 1},
    {"m3d6", CellKind::triangle, 2},     {"sfm3d3", CellKind::triangle, 1},
    {"sfm3d6", CellKind::triangle, 2},   {"r3d3", CellKind::triangle, 1},
    {"ds3", CellKind::triangle, 1},      {"ds6", CellKind::triangle, 2},
    {"s4", CellKind::quadrangle, 1},     {"s8", CellKind::quadrangle, 2},
    {"m3d4", CellKind::quadrangle, 1},   {"m3d8", CellKind::quadrangle, 2},
    {"r3d4", CellKind::quadrangle, 1},   {"sfm3d4", CellKind::quadrangle, 1},
    {"sfm3d8", CellKind::quadrangle, 2}, {"t3d2", CellKind::edge, 1},
    {"t3d3", CellKind::edge, 2},         {"b31", CellKind::edge, 1},
    {"b32", CellKind::edge, 2},          {"t2d2", CellKind::edge, 1}};

const ElementType* find_type(std::string_view name) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const ElementType* best = nullptr;
  for (const ElementType& type : element_types)
    if (name.starts_with(type.prefix) &&
        (name.size() == type.prefix.size() || !is_digit(name[type.prefix.size()])) &&
        (best == nullptr || type.prefix.size() > best->prefix.size()))
      best = &type;
  return best;
}

/// An element set. `name` is in lower case, `written` as in the file. `named_apart`: an *ELSET line names it,
/// not only *ELEMENT lines.
struct Set {
  std::string name, written;
  std::vector<std::int64_t> members;
  bool named_apart = false;
};

/// The place of an element in the mesh: which list, and its index there.
struct CellPlace {
  CellKind kind = CellKind::tet;
  Index index = 0;
  std::optional<unsigned> half = {};  ///< which half of a pyramid that is two tets in the file
};

class AbaqusReader {
 public:
  AbaqusReader(const std::string& path, std::string_view text) : path_(path), lines_(path, text) {}

  TetMesh read() {
    std::string_view line;
    while (lines_.peek(line)) {
      if (line[0] != '*')
        lines_.fail(fmt::format("expected a keyword such as *NODE, found {}", in_quotes(line)));
      const Keyword keyword(line);
      lines_.next();
      read_block(keyword);
    }
    sort_elements();
    join_halves();
    if (mesh_.tets.empty()) lines_.fail("expected tetrahedra (C3D4, C3D10), found none");
    tag_cells();
    add_surfaces();
    complete_mesh(path_, mesh_);
    return std::move(mesh_);
  }

 private:
  using Fields = std::vector<std::string_view>;

  void read_block(const Keyword& keyword) {
    if (keyword.name == "node")
      each_line([&](const Fields& fields) { read_node(fields); });
    else if (keyword.name == "element")
      read_elements(keyword);
    else if (keyword.name == "elset")
      read_set(keyword);
    else if (keyword.name == "surface")
      read_surface(keyword);
    else if (keyword.name == "include")
      lines_.fail("*INCLUDE is not supported; copy the included files into this one");
    else if (keyword.name == "instance")
      read_instance();
    else
      each_line([](const Fields&) {});
  }

  template <class Read>
  void each_line(Read read) {
    std::string_view line;
    Fields fields;
    while (lines_.peek(line) && line[0] != '*') {
      split(line, fields);
      read(fields);
      lines_.next();
    }
  }

  std::int64_t integer(std::string_view field, std::string_view what) const {
    std::int64_t value = 0;
    if (!parse(field, value))
      lines_.fail(fmt::format("expected {}, an integer, found {}", what, in_quotes(field)));
    return value;
  }

  double coordinate(std::string_view field) const {
    double value = 0;
    std::string text(field);
    std::replace(text.begin(), text.end(), 'd', 'e');
    std::replace(text.begin(), text.end(), 'D', 'e');
    if (!parse(text, value) || !std::isfinite(value))
      lines_.fail(
          fmt::format("expected a coordinate of a node, a finite number, found {}", in_quotes(field)));
    return value;
  }

  void read_node(const Fields& fields) {
    if (fields.size() < 2) lines_.fail("expected the number of a node and its coordinates");
    nodes_.add(integer(fields[0], "the number of a node"));
    Point p;
    for (std::size_t axis = 0; axis < 3 && axis + 1 < fields.size(); ++axis)
      if (!fields[axis + 1].empty()) p[axis] = coordinate(fields[axis + 1]);
    mesh_.points.push_back(p);
    sorted_ = false;
  }

  void sort_nodes() {
    if (sorted_) return;
    sorted_ = true;
    if (const auto twice = nodes_.sort())
      lines_.fail(
          fmt::format("two nodes have the number {}; several parts are not supported, "
                      "export a flat input file",
                      *twice));
  }

  void read_elements(const Keyword& keyword) {
    sort_nodes();
    const ElementType* type = find_type(keyword["type"]);
    if (type == nullptr)
      lines_.fail(
          fmt::format("elements of type {} are not supported, only tetrahedra (C3D4, C3D10), prisms (C3D6, "
                      "C3D15), pyramids (C3D5), triangles (S3, S6, CPS3, ...), quadrangles (S4, S8, ...) and "
                      "lines (T3D2, B31, ...)",
                      in_quotes(keyword["type"])));
    const std::size_t set_index = keyword.set.empty() ? none : index_of_set(keyword.set);
    // An element may continue over several lines.
    std::vector<std::int64_t> numbers;
    each_line([&](const Fields& fields) {
      for (const std::string_view field : fields) {
        if (field.empty()) continue;
        numbers.push_back(integer(field, "the number of an element or node"));
        if (numbers.size() < type->nodes() + 1) continue;
        add_element(*type, numbers, set_index);
        numbers.clear();
      }
    });
    if (!numbers.empty())
      lines_.fail(
          fmt::format("expected an element of {} nodes, found {}", type->nodes(), numbers.size() - 1));
  }

  void add_element(const ElementType& type, const std::vector<std::int64_t>& numbers, std::size_t set) {
    std::vector<Index> listed;
    for (std::size_t k = 1; k < numbers.size(); ++k) {
      listed.push_back(nodes_.find(numbers[k]));
      if (listed.back() == none)
        lines_.fail(
            fmt::format("element {} has the node {}, but no node has that number", numbers[0], numbers[k]));
    }
    const CellPlace place{type.kind, static_cast<Index>(count_of(mesh_, type.kind))};
    add_cell(type.kind, nodes_of_element(type, listed, numbers[0]), mesh_);
    elements_.add(numbers[0]);
    places_.push_back(place);
    if (set != none) sets_[set].members.push_back(numbers[0]);
  }

  CellNodes nodes_of_element(const ElementType& type, const std::vector<Index>& listed,
                             std::int64_t number) const {
    if (type.is_hexahedron()) {
      const std::optional<CellNodes> pyramid = CellNodes::gathered(listed, abaqus_pyramid_order);
      if (pyramid) return *pyramid;
      lines_.fail(fmt::format(
          "element {} is a hexahedron, which is not supported, unless its last four nodes are the same",
          number));
    }
    CellNodes nodes;
    for (const Index node : listed) nodes.add(node);
    // In the file the mid-edge node is the second of three.
    return type.kind == CellKind::edge ? nodes.in_order(std::array<std::uint8_t, 3>{0, 2, 1}) : nodes;
  }

  void sort_elements() {
    if (const auto twice = elements_.sort())
      lines_.fail(fmt::format("two elements have the number {}", *twice));
  }

  /// Joins the halves of our pyramids of second order.
  void join_halves() {
    const auto set = set_index_.find(abaqus_halves);
    if (set == set_index_.end()) return;
    std::vector<Index> elements;
    for (const std::int64_t number : sets_[set->second].members) elements.push_back(elements_.find(number));
    std::vector<std::array<Index, 2>> pairs;
    for (std::size_t k = 0; k + 1 < elements.size(); k += 2) {
      for (const std::size_t each : {k, k + 1})
        if (elements[each] == none || places_[elements[each]].kind != CellKind::tet) return;
      pairs.push_back({places_[elements[k]].index, places_[elements[k + 1]].index});
    }
    const auto before = static_cast<Index>(mesh_.layers.pyramids.size());
    const auto numbers = join_pyramids(pairs, mesh_);
    if (!numbers)
      lines_.fail(fmt::format(
          "the set {} must list pairs of tetrahedra that are halves of a pyramid; export the mesh again",
          abaqus_halves));
    for (CellPlace& place : places_)
      if (place.kind == CellKind::tet) place.index = (*numbers)[place.index];
    for (Index k = 0; k < pairs.size(); ++k)
      for (unsigned half = 0; half < 2; ++half)
        places_[elements[2 * std::size_t{k} + half]] = {CellKind::pyramid, before + k, half};
  }

  std::size_t index_of_set(std::string_view name) {
    const auto [found, added] = set_index_.try_emplace(lower_case(name), sets_.size());
    if (added) sets_.push_back({lower_case(name), std::string(name), {}, false});
    return found->second;
  }

  /// Reads a set. Members are numbers or the names of earlier sets; with GENERATE, a line has the first and
  /// the last member and the step.
  void read_set(const Keyword& keyword) {
    const std::size_t set = index_of_set(keyword.set);
    sets_[set].named_apart = true;
    const bool generate = keyword.parameters.contains("generate");
    each_line([&](const Fields& fields) {
      if (generate)
        add_range(fields, sets_[set].members);
      else
        for (const std::string_view field : fields) add_member(field, sets_[set].members);
    });
  }

  void add_range(const Fields& fields, std::vector<std::int64_t>& members) {
    if (fields.size() < 2) lines_.fail("expected the first and last number of a range");
    const std::int64_t first = integer(fields[0], "the first number of a range"),
                       last = integer(fields[1], "the last number of a range"),
                       step = fields.size() > 2 ? integer(fields[2], "the step of a range") : 1;
    if (step < 1 || first < 0 || last < first)
      lines_.fail(fmt::format("the range from {} to {} in steps of {} is empty", first, last, step));
    const std::int64_t steps = (last - first) / step;
    if (static_cast<std::size_t>(steps) > places_.size())
      lines_.fail(fmt::format(
          "the range from {} to {} in steps of {} has more members than the {} elements before it", first,
          last, step, places_.size()));
    require_room(static_cast<std::size_t>(steps) + 1);
    for (std::int64_t k = 0; k <= steps; ++k) members.push_back(first + k * step);
  }

  void add_member(std::string_view field, std::vector<std::int64_t>& members) {
    if (field.empty()) return;
    std::int64_t number = 0;
    if (parse(field, number)) {
      members.push_back(number);
      return;
    }
    const std::vector<std::int64_t> copy = members_of(lower_case(field), field);
    require_room(copy.size());
    members.insert(members.end(), copy.begin(), copy.end());
  }

  /// Returns the members of an earlier set. `written`: the name for the message if there is no such set.
  const std::vector<std::int64_t>& members_of(const std::string& name, std::string_view written) const {
    const auto found = set_index_.find(name);
    if (found == set_index_.end())
      lines_.fail(fmt::format("no earlier element set has the name {}", in_quotes(written)));
    return sets_[found->second].members;
  }

  /// Limits the total number of members that ranges and names of other sets add: otherwise a small file could
  /// define sets of any size.
  void require_room(std::size_t members) {
    constexpr std::size_t most_repeats = 64;
    repeated_members_ += members;
    if (repeated_members_ > most_repeats * (places_.size() + 1))
      lines_.fail(
          fmt::format("sets and surfaces have more than {} times as many members as there are elements; "
                      "leave out repeated members",
                      most_repeats));
  }

  void read_surface(const Keyword& keyword) {
    const std::string_view type = keyword["type"];
    const bool of_elements = type.empty() || type == "element";
    if (of_elements) surfaces_.emplace_back(keyword.set, std::vector<Side>());
    each_line([&](const Fields& fields) {
      if (!of_elements) return;
      if (fields.size() < 2) lines_.fail("expected an element or element set and its side");
      Side side;
      const std::string name = lower_case(fields[1]);
      if (name.size() != 2 || name[0] != 's' || name[1] < '1' || name[1] > '6') return;  // a face of a shell
      side.number = static_cast<unsigned>(name[1] - '0');
      if (parse(fields[0], side.element))
        surfaces_.back().second.push_back(side);
      else
        add_sides(lower_case(fields[0]), side);
    });
  }

  struct Side {
    std::int64_t element = 0;
    unsigned number = 1;  ///< 1: S1
  };

  void add_sides(const std::string& set, Side side) {
    const std::vector<std::int64_t>& members = members_of(set, set);
    std::vector<Side>& sides = surfaces_.back().second;
    require_room(members.size());
    for (const std::int64_t element : members) {
      side.element = element;
      sides.push_back(side);
    }
  }

  /// Rejects an *INSTANCE that moves or turns its part, which is not supported.
  void read_instance() {
    each_line([&](const Fields& fields) {
      for (const std::string_view field : fields)
        if (!field.empty() && coordinate(field) != 0)
          lines_.fail("an instance that is moved or turned is not supported; export a flat input file");
    });
  }

  /// Sets the tags of cells by their sets. The first set with a name of ours decides; without such a set, the
  /// first *ELSET; then the set of the cell's *ELEMENT; last, the set of everything. The set of halves of
  /// pyramids gives no tags.
  void tag_cells() {
    Tagged tagged;
    for (const CellKind kind : all_cell_kinds) {
      tags_of(mesh_, kind).assign(count_of(mesh_, kind), 0);
      tagged[kind].resize(count_of(mesh_, kind));
    }
    for (const Set& set : sets_)
      if (is_ours(set.name)) tag_members(set, tagged);
    for (const bool named_apart : {true, false})
      for (const Set& set : sets_)
        if (set.named_apart == named_apart && !is_ours(set.name) && set.name != abaqus_everything &&
            set.name != abaqus_halves)
          tag_members(set, tagged);
    for (const Set& set : sets_)
      if (set.name == abaqus_everything) tag_members(set, tagged);
    read_volumes();
  }

  static bool is_ours(const std::string& name) {
    return tag_of_group_name(3, name) || tag_of_group_name(2, name) || tag_of_group_name(1, name);
  }
  using Tagged = PerKind<std::vector<bool>>;
  void tag_members(const Set& set, Tagged& tagged) {
    for (const std::int64_t number : set.members) {
      const Index element = elements_.find(number);
      if (element == none) continue;  // sets may name missing elements
      const auto [kind, index, half] = places_[element];
      std::vector<bool>& of_kind = tagged[kind];
      if (of_kind[index]) continue;
      of_kind[index] = true;
      tags_of(mesh_, kind)[index] = tag_of(shape_of(kind).dimension, set.written);
    }
  }

  Tag tag_of(std::size_t dimension, const std::string& name) {
    const Tag tag = groups_.find(dimension, lower_case(name));
    const bool given = is_given_name(dimension, name) && !lower_case(name).starts_with(volume_prefix_) &&
                       lower_case(name) != abaqus_everything;
    if (given) mesh_.names.set(dimension, tag, name);
    return tag;
  }

  /// Takes the regions of cells from the element sets VOLUME_1 and so on, which our own files have. Sets none
  /// if a cell is in none of these sets.
  void read_volumes() {
    PerKind<std::vector<Index>> regions;
    for (const CellKind kind : all_cell_kinds)
      if (shape_of(kind).dimension == 3) regions[kind].assign(count_of(mesh_, kind), none);
    for (const Set& set : sets_) {
      Index region = 0;
      if (!set.name.starts_with(volume_prefix_) ||
          !parse(std::string_view(set.name).substr(volume_prefix_.size()), region))
        continue;
      for (const std::int64_t number : set.members)
        if (const Index element = elements_.find(number);
            element != none && shape_of(places_[element].kind).dimension == 3)
          regions[places_[element].kind][places_[element].index] = region;
    }
    for (const std::vector<Index>& of_kind : regions)
      if (std::find(of_kind.begin(), of_kind.end(), none) != of_kind.end()) return;
    for_each_kind(mesh_, 3, [&](CellKind kind) { features_of(mesh_, kind) = std::move(regions[kind]); });
  }

  void add_surfaces() {
    for (const auto& [name, sides] : surfaces_) {
      if (sides.empty()) continue;
      const Tag tag = tag_of(2, name);
      for (const Side& side : sides) add_side(side, tag);
    }
  }

  /// Returns the side of our cell for the face `number` (1: S1); nothing for a face without area, for the
  /// face between the halves of a pyramid, and for the second half's part of the base.
  static std::optional<std::size_t> side_of(const CellPlace& place, unsigned number) {
    if (place.half) return side_of_pyramid(*place.half, number);
    const auto numbers = abaqus_faces(place.kind);
    const auto found = std::find(numbers.begin(), numbers.end(), number);
    if (found == numbers.end()) return std::nullopt;
    return static_cast<std::size_t>(found - numbers.begin());
  }

  /// Adds a side of an element to the faces, with its normal outwards.
  void add_side(const Side& side, Tag tag) {
    const Index element = elements_.find(side.element);
    if (element == none || shape_of(places_[element].kind).dimension != 3) return;
    const std::optional<std::size_t> found = side_of(places_[element], side.number);
    if (!found) return;
    const CellKind kind = places_[element].kind;
    const Index cell = places_[element].index;
    const std::size_t place = *found;
    const CellKind of_side =
        shape_of(kind).sides[place].corners == 3 ? CellKind::triangle : CellKind::quadrangle;
    const CellNodes nodes = nodes_of_side(kind, nodes_of(kind)(mesh_, cell), place);
    add_cell(of_side, six_volume_of(mesh_, kind, cell) > 0 ? nodes : turned(of_side, nodes), mesh_);
    tags_of(mesh_, of_side).push_back(tag);
  }

  const std::string& path_;
  const std::string volume_prefix_ = lower_case(abaqus_volume_prefix);
  Lines lines_;
  TetMesh mesh_;
  NumberTable nodes_, elements_;
  bool sorted_ = true;
  std::vector<CellPlace> places_;  ///< by element
  std::map<std::string, std::size_t, std::less<>> set_index_;
  std::vector<Set> sets_;
  std::size_t repeated_members_ = 0;  ///< members added by ranges and by names of other sets
  std::vector<std::pair<std::string, std::vector<Side>>> surfaces_;
  GroupTags groups_;
};

}  // namespace

TetMesh read_abaqus(const std::string& path) {
  const std::string text = read_bytes(path);
  return AbaqusReader(path, text).read();
}

}  // namespace collarmesh::io
