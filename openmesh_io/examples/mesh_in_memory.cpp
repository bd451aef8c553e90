// Builds an OpenMesh mesh in memory, meshes it, walks the tetrahedra and gets the boundary back as an
// OpenMesh mesh. To build it with CMake:
//   find_package(collarmesh REQUIRED)
//   target_link_libraries(mesh_in_memory PRIVATE collarmesh::openmesh_io)
#include <collarmesh/openmesh_io.h>
#include <collarmesh/pipeline.h>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<>;  // with floats; any traits work
using TriMesh = OpenMesh::TriMesh_ArrayKernelT<>;

/// Makes a box of quads. The face property "side" numbers the sides of the box from 1.
PolyMesh make_box(float width, float depth, float height) {
  PolyMesh mesh;
  std::vector<PolyMesh::VertexHandle> v;
  for (const float z : {0.0F, height})
    for (const auto& [x, y] : {std::array{0.0F, 0.0F}, {width, 0.0F}, {width, depth}, {0.0F, depth}})
      v.push_back(mesh.add_vertex({x, y, z}));
  OpenMesh::FPropHandleT<int> side;
  mesh.add_property(side, "side");
  int number = 0;
  for (const auto& [a, b, c, d] : {std::array<std::size_t, 4>{0, 3, 2, 1},
                                   {4, 5, 6, 7},
                                   {0, 1, 5, 4},
                                   {1, 2, 6, 5},
                                   {2, 3, 7, 6},
                                   {3, 0, 4, 7}})
    mesh.property(side, mesh.add_face({v[a], v[b], v[c], v[d]})) = ++number;
  return mesh;
}

int main() {
  namespace om = collarmesh::openmesh_io;
  const PolyMesh box = make_box(2, 1, 3);

  // The surface becomes a complex ...
  const om::SurfacesPlc complex = om::to_plc(box, {.name = "box", .patch_property = "side"});
  for (const std::string& note : complex.notes) std::printf("%s\n", note.c_str());

  // ... and the complex becomes a mesh, fine near side 2, the top.
  collarmesh::PipelineOptions options;
  options.mesh.size = 0.5;
  options.mesh.patch_size[2] = 0.2;
  options.mesh.gradation = 0.5;
  const collarmesh::PipelineResult made = collarmesh::run_pipeline(complex.plc, options);
  if (!made.guarantees_hold()) {
    std::printf("%s\n", made.result.message.c_str());
    return 1;
  }

  // Walk the tetrahedra.
  const collarmesh::TetMesh& mesh = made.result.mesh;
  double volume = 0, worst = 0;
  for (const auto& [a, b, c, d] : mesh.tets) {
    const collarmesh::TetQuality quality =
        collarmesh::measure(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
    volume += quality.volume;
    worst = std::fmax(worst, quality.radius_edge);
  }
  std::printf("%zu tets, volume %g, largest radius-edge ratio %.3f\n", mesh.tets.size(), volume, worst);

  // Get the boundary as an OpenMesh mesh, and count its triangles on the top.
  const TriMesh surface = om::boundary_surface<TriMesh>(mesh);
  OpenMesh::FPropHandleT<std::int64_t> tag;
  if (!surface.get_property_handle(tag, om::patch_tag)) return 1;
  std::size_t top = 0;
  for (const auto face : surface.faces()) top += surface.property(tag, face) == 2 ? 1 : 0;
  std::printf("%zu of %zu boundary triangles are on the top\n", top, surface.n_faces());

  return std::fabs(volume - 6) < 1e-5 && top > 0 ? 0 : 1;
}
