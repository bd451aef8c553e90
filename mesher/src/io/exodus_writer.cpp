// Exodus II (Sandia, "EXODUS II: A Finite Element Data Model", SAND92-2137, and the names of seacas'
// exodusII_int.h) in NetCDF's classic format: a block of elements for each region, a side set for each tag of
// patches and a node set for each tag of curves, with their names.
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

/// Exodus' numbers of the sides of a tetrahedron, by the opposite corner.
constexpr std::array<std::int32_t, 4> side_opposite{2, 3, 1, 4};

struct Block {
  Tag tag = 0;
  std::vector<Index> tets;
};

/// Returns whether the tag can be the value of a property.
bool fits(Tag tag) {
  return tag >= std::numeric_limits<std::int32_t>::min() && tag <= std::numeric_limits<std::int32_t>::max();
}

class ExodusFile {
 public:
  ExodusFile(const std::string& path, const TetMesh& mesh) : mesh_(mesh), out_(path) {
    for (Index t = 0; t < mesh.tets.size(); ++t) {
      Block& block = blocks_[mesh.tet_region[t]];
      block.tag = mesh.tet_tag[t];
      block.tets.push_back(t);
    }
    tags_fit_ = std::all_of(mesh.tet_tag.begin(), mesh.tet_tag.end(), fits);
    number_in_file_.resize(mesh.tets.size());
    std::int32_t number = 0;
    for (const auto& [region, block] : blocks_)
      for (const Index t : block.tets) number_in_file_[t] = ++number;
    const std::vector<SideOfTet> found = sides_of_faces(mesh);
    for (Index f = 0; f < found.size(); ++f)
      if (found[f].tet != none) side_sets_[mesh.face_tag[f]].push_back(found[f]);
    node_sets_ = nodes_by_tag(mesh, nodes_of_edge, mesh.edge_tag);
    name_all();
  }

  void write() {
    describe();
    out_.write_header();
    write_blocks();
    write_sets(side_sets_, side_numbers_, side_names_);
    for (const auto& [tag, members] : side_sets_) {
      write_wholes(members, [&](const SideOfTet& each) { return number_in_file_[each.tet]; });
      write_wholes(members, [](const SideOfTet& each) { return side_opposite[each.opposite]; });
    }
    write_sets(node_sets_, node_numbers_, node_names_);
    for (const auto& [tag, members] : node_sets_) write_wholes(members, [](Index node) { return node; });
    write_points();
    write_cells();
    out_.commit();
  }

 private:
  void name_all() {
    DistinctNames blocks(longest_name), side_sets(longest_name), node_sets(longest_name);
    for (const auto& [region, block] : blocks_)
      block_names_.push_back(blocks.add(group_name(mesh_, 3, block.tag)));
    for (const auto& [tag, members] : side_sets_)
      side_names_.push_back(side_sets.add(group_name(mesh_, 2, tag)));
    for (const auto& [tag, members] : node_sets_)
      node_names_.push_back(node_sets.add(group_name(mesh_, 1, tag)));
    for (const auto* names : {&block_names_, &side_names_, &node_names_})
      for (const std::string& name : *names) name_length_ = std::max(name_length_, name.size());
    side_numbers_ = positive_numbers(mesh_.face_tag);
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
    out_.add_dimension("num_elem", mesh_.tets.size());
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
    for (const auto& [region, block] : blocks_) {
      const std::size_t length = out_.add_dimension(fmt::format("num_el_in_blk{}", ++k), block.tets.size()),
                        nodes = out_.add_dimension(fmt::format("num_nod_per_el{}", k),
                                                   mesh_.order() == 2 ? 10 : 4);
      out_.add_whole(fmt::format("connect{}", k), {length, nodes},
                     {NetcdfWriter::text("elem_type", mesh_.order() == 2 ? "TETRA10" : "TETRA4")});
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
    write_wholes(blocks_, [](const auto&) { return 1; });
    write_wholes(blocks_, [](const auto& each) { return each.first; });
    if (tags_fit_) write_wholes(blocks_, [](const auto& each) { return each.second.tag; });
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
    for (const auto& [region, block] : blocks_) {
      for (const Index t : block.tets)
        for (const Index node : nodes_of_tet(mesh_, t)) out_.write(static_cast<std::int32_t>(node + 1));
      out_.end_variable();
    }
  }

  const TetMesh& mesh_;
  NetcdfWriter out_;
  std::map<Index, Block> blocks_;
  bool tags_fit_ = true;
  std::vector<std::int32_t> number_in_file_;  // number of each tet, block by block
  std::map<Tag, std::vector<SideOfTet>> side_sets_;
  Groups node_sets_;
  std::map<Tag, std::size_t> side_numbers_, node_numbers_;
  std::vector<std::string> block_names_, side_names_, node_names_;
  std::size_t name_length_ = usual_name, name_dimension_ = 0, axes_ = 0, nodes_ = 0;
};

}  // namespace

void write_exodus(const std::string& path, const TetMesh& mesh) { ExodusFile(path, mesh).write(); }

}  // namespace collarmesh::io
