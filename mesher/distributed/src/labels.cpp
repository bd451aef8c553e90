#include "labels.h"

#include <algorithm>

#include "calls.h"
#include "local_mesh.h"

namespace collarmesh::distributed {

void set_label(DM dm, const char* name, std::vector<std::pair<PetscInt, PetscInt>> values_and_points) {
  std::sort(values_and_points.begin(), values_and_points.end());
  PetscBool there = PETSC_FALSE;
  call(DMHasLabel(dm, name, &there));
  if (there != PETSC_FALSE) call(DMRemoveLabel(dm, name, nullptr));
  call(DMCreateLabel(dm, name));
  DMLabel label = nullptr;
  call(DMGetLabel(dm, name, &label));
  std::vector<PetscInt> values, points;
  for (const auto& [value, point] : values_and_points)
    if (values.empty() || values.back() != value) values.push_back(value);
  call(DMLabelAddStrata(label, static_cast<PetscInt>(values.size()), values.data()));
  for (std::size_t first = 0, end = 0; first < values_and_points.size(); first = end) {
    const PetscInt value = values_and_points[first].first;
    points.clear();
    for (; end < values_and_points.size() && values_and_points[end].first == value; ++end)
      points.push_back(values_and_points[end].second);
    IS stratum = nullptr;
    call(ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(points.size()), points.data(),
                         PETSC_COPY_VALUES, &stratum));
    call(DMLabelSetStratumIS(label, value, stratum));
    call(ISDestroy(&stratum));
  }
}

void keep_depth(DM dm, const char* name, PetscInt depth) {
  PetscInt first = 0, end = 0;
  call(DMPlexGetDepthStratum(dm, depth, &first, &end));
  const std::vector<PetscInt> values = label_values(dm, name, first, static_cast<std::size_t>(end - first));
  std::vector<std::pair<PetscInt, PetscInt>> kept;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] >= 0) kept.emplace_back(values[i], first + static_cast<PetscInt>(i));
  set_label(dm, name, std::move(kept));
}

void label_patches_and_curves(DM dm, const Plc& plc) {
  for (const PetscInt depth : {1, 2}) {
    PetscInt first = 0, end = 0;
    call(DMPlexGetDepthStratum(dm, depth, &first, &end));
    const std::vector<PetscInt> codes =
        label_values(dm, feature_label, first, static_cast<std::size_t>(end - first));
    std::vector<std::pair<PetscInt, PetscInt>> labels;
    for (std::size_t i = 0; i < codes.size(); ++i) {
      const auto [dimension, feature] = decoded(codes[i]);
      if (dimension != depth || feature == none) continue;
      const Tag tag = depth == 1 ? plc.curves[feature].tag : plc.patches[feature].tag;
      labels.emplace_back(static_cast<PetscInt>(tag), first + static_cast<PetscInt>(i));
    }
    set_label(dm, depth == 1 ? "curve" : "patch", std::move(labels));
  }
}

}  // namespace collarmesh::distributed
