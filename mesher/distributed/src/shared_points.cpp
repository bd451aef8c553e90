#include "shared_points.h"

#include <petscsf.h>

#include <algorithm>
#include <type_traits>

namespace collarmesh::distributed {

namespace {

/// An MPI type of several values of a basic type. For one value it is the basic type, because PETSc accepts
/// no other.
class UnitType {
 public:
  UnitType(MPI_Datatype basic, std::size_t width) : type_(basic), is_made_(width > 1) {
    if (!is_made_) return;
    MPI_Type_contiguous(static_cast<int>(width), basic, &type_);
    MPI_Type_commit(&type_);
  }
  ~UnitType() {
    if (is_made_) MPI_Type_free(&type_);
  }
  UnitType(const UnitType&) = delete;
  UnitType& operator=(const UnitType&) = delete;
  MPI_Datatype get() const { return type_; }

 private:
  MPI_Datatype type_;
  bool is_made_;
};

template <class T>
MPI_Datatype basic_type() {
  if constexpr (std::is_same_v<T, PetscInt>)
    return MPIU_INT;
  else
    return MPIU_REAL;
}

}  // namespace

SharedPoints::SharedPoints(DM dm, PetscInt depth)
    : communicator_(PetscObjectComm(reinterpret_cast<PetscObject>(dm))) {
  PetscInt end = 0;
  call(DMPlexGetDepthStratum(dm, depth, &first_, &end));
  owned_.assign(static_cast<std::size_t>(end - first_), true);
  const Ranks ranks(communicator_);
  if (ranks.count == 1) return;
  // The steps narrow the points down: all points of the DMPlex, then those of this depth, then the shared
  // ones.
  PetscSF all = nullptr;
  call(DMGetPointSF(dm, &all));
  PetscInt roots = 0, leaves = 0;
  const PetscInt* local = nullptr;
  const PetscSFNode* remote = nullptr;
  call(PetscSFGetGraph(all, &roots, &leaves, &local, &remote));
  std::vector<PetscInt> firsts(static_cast<std::size_t>(ranks.count));
  MPI_Allgather(&first_, 1, MPIU_INT, firsts.data(), 1, MPIU_INT, communicator_);
  std::vector<PetscInt> here;
  std::vector<PetscSFNode> there;
  for (PetscInt k = 0; k < leaves; ++k) {
    const PetscInt point = local != nullptr ? local[k] : k;
    if (point < first_ || point >= end) continue;
    here.push_back(point - first_);
    there.push_back({remote[k].rank, remote[k].index - firsts[static_cast<std::size_t>(remote[k].rank)]});
    owned_[static_cast<std::size_t>(point - first_)] = false;
  }
  PetscSF wide = nullptr;
  call(PetscSFCreate(communicator_, &wide));
  call(PetscSFSetGraph(wide, end - first_, static_cast<PetscInt>(here.size()), here.data(), PETSC_COPY_VALUES,
                       there.data(), PETSC_COPY_VALUES));
  const PetscInt* degrees = nullptr;
  call(PetscSFComputeDegreeBegin(wide, &degrees));
  call(PetscSFComputeDegreeEnd(wide, &degrees));
  std::vector<PetscInt> place(owned_.size(), -1), place_of_owner;
  for (std::size_t i = 0; i < owned_.size(); ++i)
    if (!owned_[i] || degrees[i] > 0) {
      place[i] = static_cast<PetscInt>(shared_.size());
      shared_.push_back(i);
    }
  place_of_owner = place;
  call(PetscSFBcastBegin(wide, MPIU_INT, place.data(), place_of_owner.data(), MPI_REPLACE));
  call(PetscSFBcastEnd(wide, MPIU_INT, place.data(), place_of_owner.data(), MPI_REPLACE));
  for (std::size_t k = 0; k < here.size(); ++k) {
    const auto i = static_cast<std::size_t>(here[k]);
    there[k].index = place_of_owner[i];
    here[k] = place[i];
  }
  call(PetscSFDestroy(&wide));
  call(PetscSFCreate(communicator_, &forest_));
  call(PetscSFSetGraph(forest_, static_cast<PetscInt>(shared_.size()), static_cast<PetscInt>(here.size()),
                       here.data(), PETSC_COPY_VALUES, there.data(), PETSC_COPY_VALUES));
}

SharedPoints::~SharedPoints() { PetscSFDestroy(&forest_); }

std::size_t SharedPoints::owned_count() const {
  return static_cast<std::size_t>(std::count(owned_.begin(), owned_.end(), true));
}

template <class T>
void SharedPoints::combine_shared(std::vector<T>& values, MPI_Op operation, std::size_t width) const {
  if (forest_ == nullptr) return;
  const UnitType unit(basic_type<T>(), width);
  std::vector<T> combined = values;
  if (operation != MPI_REPLACE) {
    call(PetscSFReduceBegin(forest_, unit.get(), values.data(), combined.data(), operation));
    call(PetscSFReduceEnd(forest_, unit.get(), values.data(), combined.data(), operation));
    values = combined;
  }
  call(PetscSFBcastBegin(forest_, unit.get(), combined.data(), values.data(), MPI_REPLACE));
  call(PetscSFBcastEnd(forest_, unit.get(), combined.data(), values.data(), MPI_REPLACE));
}
template void SharedPoints::combine_shared(std::vector<PetscInt>&, MPI_Op, std::size_t) const;
template void SharedPoints::combine_shared(std::vector<PetscReal>&, MPI_Op, std::size_t) const;

template <class T>
void SharedPoints::combine(std::vector<T>& values, MPI_Op operation, std::size_t width) const {
  if (forest_ == nullptr) return;
  std::vector<T> own(shared_.size() * width);
  for (std::size_t k = 0; k < shared_.size(); ++k)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(shared_[k] * width), width,
                own.begin() + static_cast<std::ptrdiff_t>(k * width));
  combine_shared(own, operation, width);
  for (std::size_t k = 0; k < shared_.size(); ++k)
    std::copy_n(own.begin() + static_cast<std::ptrdiff_t>(k * width), width,
                values.begin() + static_cast<std::ptrdiff_t>(shared_[k] * width));
}
template void SharedPoints::combine(std::vector<PetscInt>&, MPI_Op, std::size_t) const;
template void SharedPoints::combine(std::vector<PetscReal>&, MPI_Op, std::size_t) const;

void SharedPoints::take_owners(std::span<Point> places) const {
  std::vector<PetscReal> values;
  for (const std::size_t i : shared_) values.insert(values.end(), {places[i].x, places[i].y, places[i].z});
  combine_shared(values, MPI_REPLACE, 3);
  for (std::size_t k = 0; k < shared_.size(); ++k)
    places[shared_[k]] = {values[3 * k], values[3 * k + 1], values[3 * k + 2]};
}

}  // namespace collarmesh::distributed
