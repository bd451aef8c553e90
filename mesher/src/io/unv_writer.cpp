// The universal file format of I-DEAS (.unv): nodes (2411), elements (2412) and groups (2467). The
// material of a volume is its region; groups are named as in label_names.h.
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

void write_dataset_of_nodes(FileWriter& out, const TetMesh& mesh) {
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

const UnvType& unv_type_of(CellKind kind, int order) {
  for (const UnvType& type : unv_types)
    if (type.kind == kind && type.order == order) return type;
  return unv_types.front();
}

class ElementWriter {
 public:
  ElementWriter(FileWriter& out, const TetMesh& mesh) : out_(out), mesh_(mesh) {}

  void write(CellKind kind) {
    const UnvType& type = unv_type_of(kind, mesh_.order());
    const std::size_t dimension = shape_of(kind).dimension;
    const std::vector<Tag>& tags = tags_of(mesh_, kind);
    for (std::size_t i = 0; i < tags.size(); ++i) {
      const Index material = dimension == 3 ? features_of(mesh_, kind)[i] : 1;
      line_.clear();
      fmt::format_to(std::back_inserter(line_), "{:10}{:10}{:10}{:10}{:10}{:10}\n", ++count_, type.number,
                     material, material, 7, type.nodes);
      if (unv_is_beam(type.number)) line_ += "         0         1         1\n";
      std::size_t on_line = 0;
      const CellNodes nodes = nodes_of(kind)(mesh_, i);
      for (const std::uint8_t k : type.node_order()) {
        if (on_line == 8) line_ += '\n';
        on_line = on_line == 8 ? 1 : on_line + 1;
        fmt::format_to(std::back_inserter(line_), "{:10}", nodes[k] + 1);
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
  write_dataset_of_nodes(out, mesh);
  begin_dataset(out, unv_elements);
  ElementWriter elements(out, mesh);
  for (const CellKind kind : all_cell_kinds) elements.write(kind);
  end_dataset(out);
  elements.write_groups();
  out.commit();
}

}  // namespace collarmesh::io
