// NAME.h5: the DMPlex in PETSc's format, and the arrays of uniform grids of XDMF 3 (www.xdmf.org, "XDMF Model
// and Format"), one grid per file, as dolfinx and meshio read them.
#include <fmt/format.h>
#include <petscviewerhdf5.h>

#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string_view>

#include "calls.h"
#include "collarmesh/distributed.h"
#include "local_mesh.h"
#include "shared_points.h"

namespace collarmesh::distributed {

namespace {

namespace fs = std::filesystem;

/// The cells of one dimension that this rank owns, with global numbers.
struct Cells {
  std::string_view name;      ///< name of the grid, and of its group in the HDF5 file
  std::string_view topology;  ///< XDMF's name of the kind of cells
  std::size_t nodes_per_cell = 0;
  std::vector<PetscInt> nodes;
  std::vector<std::pair<std::string_view, std::vector<PetscInt>>> arrays;
};

struct Grid {
  std::vector<PetscReal> points;  ///< this rank's own nodes, in the order of their numbers
  std::array<Cells, 3> cells;     ///< tets, faces, edges
};

class GridMaker {
 public:
  GridMaker(DM dm, int order)
      : communicator_(PetscObjectComm(reinterpret_cast<PetscObject>(dm))),
        second_(order == 2),
        mesh_(dm, order),
        vertices_(dm, 0),
        edges_(dm, 1),
        faces_(dm, 2) {}

  /// Makes the grid. Collective.
  Grid make() {
    number_nodes();
    Grid grid;
    for (std::size_t i = 0; i < mesh_.points.size(); ++i)
      if (i < mesh_.vertices ? vertices_.owned(i) : edges_.owned(i - mesh_.vertices))
        grid.points.insert(grid.points.end(), {mesh_.points[i].x, mesh_.points[i].y, mesh_.points[i].z});
    add_tets(grid.cells[0]);
    add_faces(grid.cells[1]);
    add_edges(grid.cells[2]);
    return grid;
  }

 private:
  /// Numbers the nodes rank by rank; on each rank first its own vertices, then its own mid-edge nodes.
  void number_nodes() {
    const auto own = static_cast<PetscInt>(vertices_.owned_count() + (second_ ? edges_.owned_count() : 0));
    PetscInt next = 0;
    MPI_Exscan(&own, &next, 1, MPIU_INT, MPI_SUM, communicator_);
    if (Ranks(communicator_).rank == 0) next = 0;
    number(vertices_, next);
    if (second_) number(edges_, next);
  }
  void number(const SharedPoints& points, PetscInt& next) {
    std::vector<PetscInt> numbers(points.size(), 0);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (points.owned(i)) numbers[i] = next++;
    points.combine(numbers, MPI_REPLACE);
    numbers_.insert(numbers_.end(), numbers.begin(), numbers.end());
  }

  template <std::size_t n>
  void add_nodes(const std::array<Index, n>& nodes, Cells& cells) const {
    for (const Index node : nodes) cells.nodes.push_back(numbers_[node]);
  }

  void add_tets(Cells& cells) const {
    cells = {"mesh", second_ ? "Tetrahedron_10" : "Tetrahedron", second_ ? 10U : 4U, {}, {}};
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      add_nodes(mesh_.tets[t], cells);
      if (second_) add_nodes(mesh_.tet_mid_nodes[t], cells);
    }
    cells.arrays = {{"tag", {mesh_.tet_tag.begin(), mesh_.tet_tag.end()}},
                    {"collar", {mesh_.tet_collar.begin(), mesh_.tet_collar.end()}}};
  }

  void add_faces(Cells& cells) const {
    cells = {"faces", second_ ? "Triangle_6" : "Triangle", second_ ? 6U : 3U, {}, {{"tag", {}}}};
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      if (!faces_.owned(mesh_.face_number[f])) continue;
      add_nodes(mesh_.faces[f], cells);
      if (second_) add_nodes(mesh_.face_mid_nodes[f], cells);
      cells.arrays[0].second.push_back(static_cast<PetscInt>(mesh_.face_tag[f]));
    }
  }

  void add_edges(Cells& cells) const {
    cells = {"edges", second_ ? "Edge_3" : "Polyline", second_ ? 3U : 2U, {}, {{"tag", {}}}};
    for (std::size_t e = 0; e < mesh_.edges.size(); ++e) {
      if (!edges_.owned(mesh_.edge_number[e])) continue;
      add_nodes(mesh_.edges[e], cells);
      if (second_) add_nodes(std::array{mesh_.edge_mid_nodes[e]}, cells);
      cells.arrays[0].second.push_back(static_cast<PetscInt>(mesh_.edge_tag[e]));
    }
  }

  MPI_Comm communicator_;
  bool second_;
  LocalMesh mesh_;
  SharedPoints vertices_, edges_, faces_;
  std::vector<PetscInt> numbers_;  // by point
};

/// An HDF5 file that all ranks write.
class ValueFile {
 public:
  ValueFile(MPI_Comm communicator, const std::string& path) : communicator_(communicator) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // the program reports errors itself
    call(PetscViewerHDF5Open(communicator, path.c_str(), FILE_MODE_WRITE, &viewer_));
  }
  ~ValueFile() {
    // Closing is collective; after an error the other ranks may not take part.
    if (std::uncaught_exceptions() == 0) PetscViewerDestroy(&viewer_);
  }
  ValueFile(const ValueFile&) = delete;
  ValueFile& operator=(const ValueFile&) = delete;

  void write(DM dm) {
    // In older layouts only vertices have coordinates.
    const char* const option = "-dm_plex_view_hdf5_storage_version";
    PetscBool given = PETSC_FALSE;
    call(PetscOptionsHasName(nullptr, nullptr, option, &given));
    if (given == PETSC_FALSE) call(PetscOptionsSetValue(nullptr, option, "2.0.0"));
    call(PetscViewerPushFormat(viewer_, PETSC_VIEWER_HDF5_PETSC));
    call(DMView(dm, viewer_));
    if (given == PETSC_FALSE) call(PetscOptionsClearValue(nullptr, option));
    call(PetscViewerPopFormat(viewer_));
  }
  /// Writes rows. Returns the number of rows of all ranks together.
  std::int64_t write(const std::string& group, const std::string& name, const std::vector<PetscInt>& values,
                     std::size_t columns) {
    IS set = nullptr;
    call(ISCreateGeneral(communicator_, static_cast<PetscInt>(values.size()), values.data(),
                         PETSC_USE_POINTER, &set));
    call(ISSetBlockSize(set, static_cast<PetscInt>(columns)));
    write_object(group, name, set, [&] { return ISView(set, viewer_); });
    call(ISDestroy(&set));
    return rows(values.size(), columns);
  }
  std::int64_t write(const std::string& group, const std::string& name, const std::vector<PetscReal>& values,
                     std::size_t columns) {
    Vec set = nullptr;
    call(VecCreateMPIWithArray(communicator_, static_cast<PetscInt>(columns),
                               static_cast<PetscInt>(values.size()), PETSC_DECIDE, values.data(), &set));
    write_object(group, name, set, [&] { return VecView(set, viewer_); });
    call(VecDestroy(&set));
    return rows(values.size(), columns);
  }
  void close() { call(PetscViewerDestroy(&viewer_)); }

 private:
  template <class Object, class View>
  void write_object(const std::string& group, const std::string& name, Object object, const View& view) {
    call(PetscObjectSetName(reinterpret_cast<PetscObject>(object), name.c_str()));
    call(PetscViewerHDF5PushGroup(viewer_, group.c_str()));
    call(view());
    call(PetscViewerHDF5PopGroup(viewer_));
  }
  std::int64_t rows(std::size_t values, std::size_t columns) const {
    return all_reduce(communicator_, static_cast<std::int64_t>(values / columns), MPI_SUM);
  }

  MPI_Comm communicator_;
  PetscViewer viewer_ = nullptr;
};

std::string data_item(const std::string& file, const std::string& path, std::string_view type,
                      std::size_t bytes, std::int64_t rows, std::size_t columns) {
  return fmt::format(
      "<DataItem Format=\"HDF\" NumberType=\"{}\" Precision=\"{}\" Dimensions=\"{} {}\">{}:{}</DataItem>\n",
      type, bytes, rows, columns, file, path);
}

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw WriteError(fmt::format("{}: cannot be written; is the disk full?", path.string()));
}

/// Checks, before anything is written, that PETSc's integers can count the file's entries and that the disk
/// has room for the file.
void require_space(DM dm, const fs::path& path) {
  constexpr double bytes_per_tet = 150;  // lower bound
  const MPI_Comm communicator = PetscObjectComm(reinterpret_cast<PetscObject>(dm));
  PetscInt first = 0, end = 0;
  call(DMPlexGetHeightStratum(dm, 0, &first, &end));
  const double needed =
      bytes_per_tet * static_cast<double>(all_reduce(communicator, std::int64_t{end - first}, MPI_SUM));
  // The file has one array of the faces of all tets, the edges of all faces and the ends of all edges: about
  // 12.5 entries per tet.
  const bool countable =
      needed / bytes_per_tet * 13 < static_cast<double>(std::numeric_limits<PetscInt>::max());
  agree(communicator, [&] {
    if (!countable)
      throw WriteError(
          fmt::format("{}: has more entries than PETSc's integers can count; write .pvtu, or use a PETSc "
                      "with integers of 64 bits",
                      path.string()));
    std::error_code unknown;
    const fs::space_info space = fs::space(path.parent_path().empty() ? "." : path.parent_path(), unknown);
    if (Ranks(communicator).rank == 0 && !unknown && static_cast<double>(space.available) < needed)
      throw WriteError(fmt::format("{}: needs about {:.3g} GB, but the disk has only {:.3g} GB left",
                                   path.string(), needed / 1e9, static_cast<double>(space.available) / 1e9));
  });
}

/// Returns NAME.xdmf for the tets, NAME_faces.xdmf and NAME_edges.xdmf for the others.
fs::path xdmf_of(const fs::path& path, const Cells& cells) {
  const std::string suffix = cells.name == "mesh" ? "" : fmt::format("_{}", cells.name);
  return path.parent_path() / fmt::format("{}{}.xdmf", path.stem().string(), suffix);
}

}  // namespace

void ParallelMesh::write_h5(const std::string& path) const {
  const PetscMessages messages;
  require_space(dm_, path);
  Grid grid = GridMaker(dm_, order_).make();
  std::string geometry;
  for (Cells& cells : grid.cells) {
    const bool first = cells.name == "mesh";
    const auto own_count = static_cast<std::int64_t>(cells.nodes.size() / cells.nodes_per_cell);
    const std::int64_t count = all_reduce(communicator_, own_count, MPI_SUM);
    if (count == 0) continue;
    const fs::path xdmf = xdmf_of(path, cells);
    const fs::path h5 = first ? fs::path(path) : fs::path(xdmf).replace_extension(".h5");
    const std::string file = h5.filename().string();
    ValueFile values(communicator_, h5.string());
    if (first) {
      values.write(dm_);
      geometry = data_item(file, "/xdmf/points", "Float", sizeof(PetscReal),
                           values.write("/xdmf", "points", grid.points, 3), 3);
    }
    const std::string group = fmt::format("/xdmf/{}", cells.name);
    values.write(group, "topology", cells.nodes, cells.nodes_per_cell);
    std::string text = fmt::format(
        "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n<Grid Name=\"{}\" GridType=\"Uniform\">\n"
        "<Topology TopologyType=\"{}\" NumberOfElements=\"{}\" NodesPerElement=\"{}\">\n{}</Topology>\n"
        "<Geometry GeometryType=\"XYZ\">\n{}</Geometry>\n",
        cells.name, cells.topology, count, cells.nodes_per_cell,
        data_item(file, group + "/topology", "Int", sizeof(PetscInt), count, cells.nodes_per_cell), geometry);
    for (const auto& [name, array] : cells.arrays) {
      values.write(group, std::string(name), array, 1);
      text += fmt::format(
          "<Attribute Name=\"{}\" AttributeType=\"Scalar\" Center=\"Cell\">\n{}</Attribute>\n", name,
          data_item(file, fmt::format("{}/{}", group, name), "Int", sizeof(PetscInt), count, 1));
    }
    values.close();
    agree(communicator_, [&] {
      if (Ranks(communicator_).rank == 0) write_text(xdmf, text + "</Grid>\n</Domain>\n</Xdmf>\n");
    });
    cells = {};
  }
}

}  // namespace collarmesh::distributed
