#pragma once

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

namespace collarmesh::openmesh_io {

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using DoubleMesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;

/// A guard that silences OpenMesh, which would print to the standard streams; our libraries never print.
class Quiet {
 public:
  Quiet() : errors_(omerr().is_enabled()), log_(omlog().is_enabled()) {
    omerr().disable();
    omlog().disable();
  }
  ~Quiet() {
    if (errors_) omerr().enable();
    if (log_) omlog().enable();
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  bool errors_, log_;
};

}  // namespace collarmesh::openmesh_io
