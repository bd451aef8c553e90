// The universal file format of I-DEAS (.unv): nodes (2411), elements (2412) and groups (2467). The
// material of a tet is its region; groups are named as in label_names.h.
#include <fmt/format.h>

#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "io/cell_nodes.h"
#include "io/file_writer.h"
#include "io/label_names.h"
#include "io/tet_mesh_formats.h"
#include "io/unv_format.h"

namespace collarmesh::io {

namespace {

/// Appends a number in Fortran's format 1PD25.16.
void append_real(std::string& line, double value) {
  const std::size_t first = line.size();
  fmt::format_to(std::back_inserter(line), "{:25.16E}", value);
  line[line.find('E', first)] = 'D';
}

void begin_dataset(FileWriter& out, int number) { out << fmt::format("    -1\n{:6}\n", number); }
void end_dataset(FileWriter& out) { out << "    -1\n"; }

void write_nodes(FileWriter& out, const TetMesh& mesh) {
  begin_dataset(out, unv_nodes);
  std::string line;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    line.clear();
    fmt::format_to(std::back_inserter(line), "{:10}{:10}{:10}{:10}\n", i + 1, 1, 1, 11);
    for (std::size_t axis = 0; axis < 3; ++axis) append_real(line, mesh.points[i][axis]);
    out << line << '\n';
  }
  end_dataset(out);
}

const UnvType& type_of(std::size_t dimension, std::size_t nodes) {
  for (const UnvType& type : unv_types)
    if (type.dimension == dimension && type.nodes == nodes) return type;
  return unv_types.front();
}

class ElementWriter {
 public:
  ElementWriter(FileWriter& out, const TetMesh& mesh) : out_(out), mesh_(mesh) {}

  template <class NodesOf>
  void write(std::size_t dimension, const std::vector<Tag>& tags, const std::vector<Index>* materials,
             NodesOf nodes_of) {
    for (std::size_t i = 0; i < tags.size(); ++i) {
      const CellNodes nodes = nodes_of(mesh_, i);
      const UnvType& type = type_of(dimension, nodes.size());
      const Index material = materials != nullptr ? (*materials)[i] : 1;
      line_.clear();
      fmt::format_to(std::back_inserter(line_), "{:10}{:10}{:10}{:10}{:10}{:10}\n", ++count_, type.number,
                     material, material, 7, nodes.size());
      if (unv_is_beam(type.number)) line_ += "         0         1         1\n";
      std::size_t on_line = 0;
      for (const Index v : nodes.in_order({type.order.data(), type.nodes})) {
        if (on_line++ == 8) line_ += '\n';
        fmt::format_to(std::back_inserter(line_), "{:10}", v + 1);
      }
      out_ << line_ << '\n';
      groups_[{dimension, tags[i]}].push_back(count_);
    }
  }

  /// Writes groups, two members per line.
  void write_groups() {
    begin_dataset(out_, unv_groups);
    std::size_t number = 0;
    for (const auto& [key, members] : groups_) {
      out_ << fmt::format("{:10}{:10}{:10}{:10}{:10}{:10}{:10}{:10}\n{}\n", ++number, 0, 0, 0, 0, 0, 0,
                          members.size(), group_name(mesh_, key.first, key.second, "-"));
      for (std::size_t i = 0; i < members.size(); ++i) {
        line_.clear();
        fmt::format_to(std::back_inserter(line_), "{:10}{:10}{:10}{:10}", unv_group_element, members[i], 0,
                       0);
        if (i % 2 == 1 || i + 1 == members.size()) line_ += '\n';
        out_ << line_;
      }
    }
    end_dataset(out_);
  }

 private:
  FileWriter& out_;
  const TetMesh& mesh_;
  std::string line_;
  std::size_t count_ = 0;
  std::map<std::pair<std::size_t, Tag>, std::vector<std::size_t>> groups_;
};

}  // namespace

void write_unv(const std::string& path, const TetMesh& mesh) {
  FileWriter out(path);
  write_nodes(out, mesh);
  begin_dataset(out, unv_elements);
  ElementWriter elements(out, mesh);
  elements.write(3, mesh.tet_tag, &mesh.tet_region, nodes_of_tet);
  elements.write(2, mesh.face_tag, nullptr, nodes_of_face);
  elements.write(1, mesh.edge_tag, nullptr, nodes_of_edge);
  end_dataset(out);
  elements.write_groups();
  out.commit();
}

}  // namespace collarmesh::io
