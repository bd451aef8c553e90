// Exodus II (Sandia, "EXODUS II: A Finite Element Data Model", SAND92-2137, and the names of seacas'
// exodusII_int.h) in NetCDF's classic format: a block of elements for each region and kind of cells, a side
// set for each tag of patches and a node set for each tag of curves, with their names.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "io/cell_nodes.h"
#include "io/label_names.h"
#include "io/netcdf_writer.h"
#include "io/node_groups.h"
#include "io/sides_of_faces.h"
#include "io/tet_mesh_formats.h"

namespace collarmesh::io {

namespace {

constexpr std::size_t longest_name = 255, usual_name = 32;

/// Exodus' names for a kind of cells, and its number for each of our sides.
struct ExodusType {
  CellKind kind;
  std::array<const char*, 2> names;  ///< by order
  std::array<std::int32_t, 5> sides;
};
constexpr std::array<ExodusType, 3> exodus_types{
    {{CellKind::tet, {"TETRA4", "TETRA10"}, {2, 3, 1, 4, 0}},
     {CellKind::prism, {"WEDGE6", "WEDGE15"}, {4, 5, 1, 2, 3}},
     {CellKind::pyramid, {"PYRAMID5", "PYRAMID13"}, {5, 1, 2, 3, 4}}}};

const ExodusType& type_of(CellKind kind) { return exodus_types[static_cast<std::size_t>(kind)]; }

/// The cells of a kind in a region.
struct Block {
  CellKind kind = CellKind::tet;
  Index region = 0;
  std::size_t id = 0;
  Tag tag = 0;
  std::vector<Index> cells;
};

/// Returns whether the tag fits into a property, which has 32 bits.
bool fits(Tag tag) {
  return tag >= std::numeric_limits<std::int32_t>::min() && tag <= std::numeric_limits<std::int32_t>::max();
}

class ExodusFile {
 public:
  ExodusFile(const std::string& path, const TetMesh& mesh) : mesh_(mesh), out_(path) {
    make_blocks();
    side_sets_ = sides_by_tag(mesh);
    node_sets_ = nodes_by_tag(mesh, 1);
    name_all();
  }

  void write() {
    describe();
    out_.write_header();
    write_blocks();
    write_sets(side_sets_, side_numbers_, side_names_);
    for (const auto& [tag, members] : side_sets_) {
      write_wholes(members, [&](const SideOfCell& each) { return number_in_file_[each.kind][each.cell]; });
      write_wholes(members, [](const SideOfCell& each) { return type_of(each.kind).sides[each.side]; });
    }
    write_sets(node_sets_, node_numbers_, node_names_);
    for (const auto& [tag, members] : node_sets_) write_wholes(members, [](Index node) { return node; });
    write_points();
    write_cells();
    out_.commit();
  }

 private:
  /// Makes a block for each region and kind of cells. The first block of a region gets the region's number as
  /// its id; the region's further blocks get ids above the numbers of all regions.
  void make_blocks() {
    std::map<std::pair<Index, CellKind>, Block> blocks;
    for_each_kind(mesh_, 3, [&](CellKind kind) {
      number_in_file_[kind].resize(count_of(mesh_, kind));
      for (Index i = 0; i < count_of(mesh_, kind); ++i) {
        const Index region = features_of(mesh_, kind)[i];
        Block& block = blocks[{region, kind}];
        block.kind = kind;
        block.region = region;
        block.tag = tags_of(mesh_, kind)[i];
        tags_fit_ = tags_fit_ && fits(block.tag);
        block.cells.push_back(i);
      }
    });
    std::size_t last = blocks.empty() ? 0 : blocks.rbegin()->first.first;
    std::int32_t number = 0;
    for (auto& [key, block] : blocks) {
      const bool first = blocks_.empty() || blocks_.back().region != block.region;
      block.id = first ? block.region : ++last;
      for (const Index i : block.cells) number_in_file_[block.kind][i] = ++number;
      blocks_.push_back(std::move(block));
    }
  }

  void name_all() {
    DistinctNames blocks(longest_name), side_sets(longest_name), node_sets(longest_name);
    for (const Block& block : blocks_) block_names_.push_back(blocks.add(group_name(mesh_, 3, block.tag)));
    for (const auto& [tag, members] : side_sets_)
      side_names_.push_back(side_sets.add(group_name(mesh_, 2, tag)));
    for (const auto& [tag, members] : node_sets_)
      node_names_.push_back(node_sets.add(group_name(mesh_, 1, tag)));
    for (const auto* names : {&block_names_, &side_names_, &node_names_})
      for (const std::string& name : *names) name_length_ = std::max(name_length_, name.size());
    side_numbers_ = positive_numbers(all_tags(mesh_, 2));
    node_numbers_ = positive_numbers(mesh_.edge_tag);
  }

  void describe() {
    out_.add_attribute(NetcdfWriter::real("api_version", 8.03F));
    out_.add_attribute(NetcdfWriter::real("version", 8.03F));
    out_.add_attribute(NetcdfWriter::whole("floating_point_word_size", 8));
    out_.add_attribute(NetcdfWriter::whole("file_size", 1));
    out_.add_attribute(NetcdfWriter::whole("maximum_name_length", static_cast<std::int32_t>(name_length_)));
    out_.add_attribute(NetcdfWriter::whole("int64_status", 0));
    out_.add_attribute(NetcdfWriter::text("title", "Written by collarmesh."));
    out_.add_dimension("len_string", usual_name + 1);
    out_.add_dimension("len_line", 81);
    out_.add_dimension("four", 4);
    name_dimension_ = out_.add_dimension("len_name", name_length_ + 1);
    const std::size_t time = out_.add_unlimited_dimension("time_step");
    axes_ = out_.add_dimension("num_dim", 3);
    nodes_ = out_.add_dimension("num_nodes", mesh_.points.size());
    out_.add_dimension("num_elem", count_of_dimension(mesh_, 3));
    out_.add_real("time_whole", {time});
    const std::size_t count = out_.add_dimension("num_el_blk", blocks_.size());
    out_.add_whole("eb_status", {count});
    out_.add_whole("eb_prop1", {count}, {NetcdfWriter::text("name", "ID")});
    if (tags_fit_) out_.add_whole("eb_prop2", {count}, {NetcdfWriter::text("name", "TAG")});
    out_.add_text("eb_names", {count, name_dimension_});
    describe_sets("side", "ss", side_sets_.size());
    std::size_t k = 0;
    for (const auto& [tag, members] : side_sets_) {
      const std::size_t length = out_.add_dimension(fmt::format("num_side_ss{}", ++k), members.size());
      out_.add_whole(fmt::format("elem_ss{}", k), {length});
      out_.add_whole(fmt::format("side_ss{}", k), {length});
    }
    describe_sets("node", "ns", node_sets_.size());
    k = 0;
    for (const auto& [tag, members] : node_sets_) {
      const std::size_t length = out_.add_dimension(fmt::format("num_nod_ns{}", ++k), members.size());
      out_.add_whole(fmt::format("node_ns{}", k), {length});
    }
    for (const char axis : {'x', 'y', 'z'}) out_.add_real(fmt::format("coord{}", axis), {nodes_});
    out_.add_text("coor_names", {axes_, name_dimension_});
    describe_cells();
  }

  void describe_sets(const char* kind, const char* mark, std::size_t count) {
    if (count == 0) return;
    const std::size_t sets = out_.add_dimension(fmt::format("num_{}_sets", kind), count);
    out_.add_whole(fmt::format("{}_status", mark), {sets});
    out_.add_whole(fmt::format("{}_prop1", mark), {sets}, {NetcdfWriter::text("name", "ID")});
    out_.add_text(fmt::format("{}_names", mark), {sets, name_dimension_});
  }

  void describe_cells() {
    std::size_t k = 0;
    for (const Block& block : blocks_) {
      const std::size_t length = out_.add_dimension(fmt::format("num_el_in_blk{}", ++k), block.cells.size()),
                        nodes = out_.add_dimension(fmt::format("num_nod_per_el{}", k),
                                                   shape_of(block.kind).nodes(mesh_.order()));
      out_.add_whole(
          fmt::format("connect{}", k), {length, nodes},
          {NetcdfWriter::text("elem_type", type_of(block.kind).names[mesh_.order() == 2 ? 1 : 0])});
    }
  }

  template <class Range, class ValueOf>
  void write_wholes(const Range& range, const ValueOf& value_of) {
    for (const auto& each : range) out_.write(static_cast<std::int32_t>(value_of(each)));
    out_.end_variable();
  }

  void write_names(const std::vector<std::string>& names) {
    for (const std::string& name : names) out_.write(name, name_length_ + 1);
    out_.end_variable();
  }

  void write_blocks() {
    write_wholes(blocks_, [](const Block&) { return 1; });
    write_wholes(blocks_, [](const Block& each) { return each.id; });
    if (tags_fit_) write_wholes(blocks_, [](const Block& each) { return each.tag; });
    write_names(block_names_);
  }

  template <class Sets>
  void write_sets(const Sets& sets, const std::map<Tag, std::size_t>& numbers,
                  const std::vector<std::string>& names) {
    if (sets.empty()) return;
    write_wholes(sets, [](const auto&) { return 1; });
    write_wholes(sets, [&](const auto& each) { return numbers.at(each.first); });
    write_names(names);
  }

  void write_points() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const Point& p : mesh_.points) out_.write(p[axis]);
      out_.end_variable();
    }
    write_names({"x", "y", "z"});
  }

  void write_cells() {
    for (const Block& block : blocks_) {
      for (const Index i : block.cells)
        for (const Index node : with_between_before_top(block.kind, nodes_of(block.kind)(mesh_, i)))
          out_.write(static_cast<std::int32_t>(node + 1));
      out_.end_variable();
    }
  }

  const TetMesh& mesh_;
  NetcdfWriter out_;
  std::vector<Block> blocks_;
  bool tags_fit_ = true;
  PerKind<std::vector<std::int32_t>> number_in_file_;  // numbers from 1, block by block
  std::map<Tag, std::vector<SideOfCell>> side_sets_;
  Groups node_sets_;
  std::map<Tag, std::size_t> side_numbers_, node_numbers_;
  std::vector<std::string> block_names_, side_names_, node_names_;
  std::size_t name_length_ = usual_name, name_dimension_ = 0, axes_ = 0, nodes_ = 0;
};

}  // namespace

void write_exodus(const std::string& path, const TetMesh& mesh) { ExodusFile(path, mesh).write(); }

}  // namespace collarmesh::io
