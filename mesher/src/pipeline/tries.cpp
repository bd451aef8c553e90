#include "pipeline/tries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <new>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "check/findings.h"
#include "check/guarantees.h"
#include "collarmesh/plc_builder.h"
#include "common/thread_limit.h"
#include "pipeline/certification.h"
#include "pipeline/explosion.h"
#include "pipeline/lost_parts.h"
#include "pipeline/vertex_bound.h"
#include "tolerance/thin_places.h"

namespace collarmesh::pipeline {

namespace {

/// Sets the size relative to which features are small, and the tags of patches and curves with sizes of their
/// own. Sets nothing if there is a size field, so that no feature is collapsed.
void find_feature_size(const MeshOptions& mesh, RepairOptions& repair) {
  if (mesh.size_field) return;
  double size = mesh.size;
  const auto add = [&](const std::map<Tag, double>& sizes, std::vector<Tag>* kept) {
    for (const auto& [tag, asked] : sizes) {
      size = size > 0 ? std::min(size, asked) : asked;
      if (kept != nullptr) kept->push_back(tag);
    }
  };
  add(mesh.region_size, nullptr);
  add(mesh.patch_size, &repair.kept_patches);
  add(mesh.curve_size, &repair.kept_curves);
  repair.target_size = size;
}

/// Throws PlcError unless a coarser repair changed something and lost no part.
void require_kept(const SoupPipelineResult& finer, const SoupPipelineResult& coarser) {
  const bool same =
      finer.plc.triangles.size() == coarser.plc.triangles.size() && finer.plc.points == coarser.plc.points;
  const std::string lost =
      same ? "nothing would change" : lost_parts(finer.plc, finer.repair, coarser.plc, coarser.repair);
  if (!lost.empty()) throw PlcError(lost, {});
}

std::vector<Point> points_near(const Plc& plc, const Point& place, double radius) {
  std::vector<Point> near;
  std::ranges::copy_if(plc.points, std::back_inserter(near),
                       [&](const Point& p) { return squared_distance(p, place) < radius * radius; });
  std::ranges::sort(near, {}, [](const Point& p) { return std::tuple(p.x, p.y, p.z); });
  return near;
}

/// Throws PlcError unless another repair changed something near the place where a guarantee was missed, and
/// lost no part.
void require_change(const SoupPipelineResult& before, const SoupPipelineResult& other,
                    const std::optional<Point>& place) {
  constexpr double near = 0.02;  // relative to the diagonal
  require_kept(before, other);
  if (!place) return;
  const double radius = near * before.plc.bounds.diagonal();
  const std::vector<Point> near_before = points_near(before.plc, *place, radius);
  if (!near_before.empty() && near_before == points_near(other.plc, *place, radius))
    throw PlcError("nothing would change there", {});
}

}  // namespace

void Tries::mesh(const Plc& plc) {
  job_.budget.bound(may_start_constrained(job_.given) ? Ways::others : Ways::none);
  std::exception_ptr error;
  const auto [end, why] = attempt(plc, error);
  if (end == End::refused) std::rethrow_exception(error);
  if (end == End::exploded) {
    job_.budget.bound(Ways::none);
    maker_.make_anyhow(plc, why, exploded_at_);
  }
  if (job_.start == Start::constrained)
    maker_.try_seeds_of_constrained(plc);
  else if (end != End::missed || !come_nearer_where_missed(plc))
    try_seeds(plc);
  keep_volumes(plc);
}

void Tries::mesh_repaired(SoupPipelineResult& all) {
  mesh_any_repaired(all);
  keep_volumes(all.plc);
  maker_.move_to(all.plc);  // later stages and the options refer to this object
}

void Tries::mesh_any_repaired(SoupPipelineResult& all) {
  constexpr double share_of_time = 0.5;
  const PipelineOptions& given = job_.given;
  PipelineResult& made = job_.made;
  build(given.repair, all);
  RepairOptions current = given.repair;
  const std::string sharp = repair_sharp_creases(current, all);
  if (job_.start == Start::constrained) {
    job_.budget.bound(Ways::none);
    maker_.make(all.plc, given.mesh.seed);
    return maker_.try_seeds_of_constrained(all.plc);
  }
  job_.budget.bound(Ways::others);
  std::exception_ptr error;
  const auto tried = attempt_simplest(current, all, error);
  const End end = tried.first;
  const std::string& why = tried.second;
  if (!sharp.empty() && end != End::exploded && end != End::refused) made.check.notes.push_back(sharp);
  if (end == End::holds) return;
  const std::vector<RepairOptions> repairs = repairs_after(end, all);
  if (end == End::exploded) job_.budget.tighten();
  const bool gave_up_constrained = maker_.has_given_up_constrained(all.plc);
  bool has_mesh = end == End::missed, built_last = true;
  std::optional<Point> place;
  // A repair must change something at the first finding. But if the refinement was far too fine, a change at
  // any place far thinner than the sizes may help.
  if (!made.check.findings.empty() && !maker_.was_far_too_fine()) place = made.check.findings.front().where;
  if (end == End::missed && come_nearer_where_missed(all.plc)) return;
  for (const RepairOptions& repair : repairs) {
    SoupPipelineResult other;
    bool better = false;
    const auto try_repair = [&] {
      better = find_better(has_mesh, [&] {
        built_last = false;
        build(repair, other);
        if (repair.wrap_at_once) job_.budget.bound(Ways::none);
        if (end == End::exploded && !repair.wrap_at_once) require_kept(all, other);
        if (end == End::missed && !repair.wrap_at_once) require_change(all, other, place);
        maker_.make(other.plc, given.mesh.seed);
      });
    };
    // A time limit that ends a try must leave time to build the complex of the mesh at hand again.
    if (has_mesh)
      job_.control.attempt(share_of_time, try_repair);
    else
      try_repair();
    if (!better) continue;
    built_last = true;
    current = repair;
    all.plc = std::move(other.plc);
    all.repair = std::move(other.repair);
    has_mesh = true;
    made.check.notes.push_back(
        all.repair.wrapped ? fmt::format("wrapped, because without wrapping: {}", why)
                           : fmt::format("repaired with a tolerance of {:.3g}, because with {:.3g}: {}",
                                         repair.tolerance, given.repair.tolerance, why));
    if (made.guarantees_hold() || end == End::exploded) break;
  }
  if (has_mesh && made.guarantees_hold()) return;
  if (!built_last) {
    try {
      build(current, all);  // so that the source built this complex last
      if (gave_up_constrained && !has_mesh) maker_.give_up_constrained(all.plc);
    } catch (const PlcError&) {
      if (!has_mesh) throw;
      return;
    }
  }
  if (!has_mesh) {
    job_.budget.bound(Ways::none);
    if (error) {
      std::optional<PipelineResult> constrained = maker_.from_constrained(all.plc, why, Hope::any);
      if (!constrained) std::rethrow_exception(error);
      made = std::move(*constrained);
      return;
    }
    maker_.make_anyhow(all.plc, why, exploded_at_);
  } else if (end == End::exploded) {
    job_.budget.bound(all.repair.wrapped ? Ways::none : Ways::others);
  }
  try_seeds(all.plc);
}

/// Repairs the input with a larger tolerance if the repaired complex has creases so sharp that refinement
/// would hardly end, the larger tolerance leaves none nearly as sharp, and nothing is lost. Sets the repair
/// that is used, and returns a note about it; empty if nothing changed.
std::string Tries::repair_sharp_creases(RepairOptions& repair, SoupPipelineResult& all) {
  // An angle in degrees, and the factor by which a larger tolerance must enlarge the smallest angle.
  constexpr double too_sharp = 0.1, blunter = 3;
  if (!all.repair.repaired || all.repair.wrapped) return {};
  const std::vector<Crease> creases = find_creases(all.plc, too_sharp);
  if (creases.empty()) return {};
  const double diagonal = all.plc.bounds.diagonal();
  for (const RepairOptions& coarser :
       coarser_repairs(repair, smallest_size(job_.given.mesh, diagonal), diagonal)) {
    SoupPipelineResult other;
    try {
      build(coarser, other);
      require_kept(all, other);
    } catch (const PlcError&) {
      continue;
    }
    if (!find_creases(other.plc, blunter * creases.front().angle).empty()) continue;
    repair = coarser;
    all.plc = std::move(other.plc);
    all.repair = std::move(other.repair);
    return fmt::format(
        "repaired with a tolerance of {:.3g}, because with {:.3g}, features meet at {:.2g} degrees at {}",
        coarser.tolerance, job_.given.repair.tolerance, creases.front().angle,
        checks::At{creases.front().where});
  }
  build(repair, all);  // so that the source built this complex last
  return {};
}

/// Meshes the complex. If features thinner than the feature size make its refinement far finer than the
/// sizes ask for, tries constrained tetrahedra, then tries to overlay these features, and if both fail,
/// allows the fine refinement. Sets the repair that is used.
std::pair<Tries::End, std::string> Tries::attempt_simplest(RepairOptions& repair, SoupPipelineResult& all,
                                                           std::exception_ptr& error) {
  if (!may_overlay()) return attempt(all.plc, error);
  maker_.set_fineness(Fineness::as_asked);
  auto tried = attempt(all.plc, error);
  bool gave_up = false, better = false;
  std::optional<PipelineResult> nearly_good;
  std::size_t constrained_vertices = 0;
  if (tried.first == End::too_fine) {
    better = maker_.take_constrained(all.plc, "thin features take far more vertices than the sizes ask for",
                                     MeshMaker::Lengths::kept);
    gave_up = maker_.has_given_up_constrained(all.plc);
    nearly_good = maker_.take_nearly_good();
    constrained_vertices = maker_.constrained_vertices();
    if (!better) better = overlay_thin_features(repair, all, most_asked_for_);
  }
  maker_.set_fineness(Fineness::any);
  if (better) return {End::holds, {}};
  if (tried.first != End::too_fine) return tried;
  build(repair, all);  // so that the source built this complex last
  if (gave_up) maker_.give_up_constrained(all.plc);
  job_.budget.compare_with(constrained_vertices);
  tried = attempt(all.plc, error);
  if (tried.first == End::missed && nearly_good && misses_far_less(*nearly_good, job_.made)) {
    maker_.use_constrained(std::move(*nearly_good));
    tried.second = job_.made.missed();
  }
  return tried;
}

bool Tries::may_overlay() const {
  const PipelineOptions& given = job_.given;
  return given.coarsen && given.repair.feature_size > 0 && given.mesh.profile == Profile::standard &&
         !given.mesh.size_field && !given.periodic.any();
}

/// Repairs the input with a larger tolerance, up to the feature size, so that opposite sides of thin walls
/// and gaps become one. Returns whether the resulting mesh keeps every guarantee and loses no part; otherwise
/// restores everything. `most`: the number of vertices that the sizes ask for.
bool Tries::overlay_thin_features(RepairOptions& repair, SoupPipelineResult& all, std::size_t most) {
  const double diagonal = all.plc.bounds.diagonal(), size = smallest_size(job_.given.mesh, diagonal),
               thin = thinner_than_asked(job_.given, diagonal);
  for (const RepairOptions& coarser : coarser_repairs(repair, size, diagonal)) {
    if (coarser.tolerance * diagonal > thin) break;
    SoupPipelineResult other;
    if (!find_better(true, [&] {
          build(coarser, other);
          require_kept(all, other);
          if (other.plc.regions.size() != all.plc.regions.size())
            throw PlcError("a region would be lost", {});
          double squares = 0;
          ThreadLimit(job_.given.mesh.threads).run([&] {
            squares = squares_in_thin_places(other.plc, thin);
          });
          if (squares > static_cast<double>(most)) throw PlcError("thin features would be left", {});
          maker_.give_up_constrained(other.plc);
          maker_.make(other.plc, job_.given.mesh.seed);
        }))
      continue;
    const double before = std::exchange(repair, coarser).tolerance;
    all.plc = std::move(other.plc);
    all.repair = std::move(other.repair);
    job_.made.check.notes.push_back(fmt::format(
        "repaired with a tolerance of {:.3g}, because with {:.3g}, features thinner than the feature size "
        "take more than {} vertices, far more than the sizes ask for; feature-size 0 keeps these features",
        coarser.tolerance, before, most));
    return true;
  }
  return false;
}

void Tries::build(RepairOptions repair, SoupPipelineResult& all) {
  job_.control.begin("complex", 0, 0.06);
  find_feature_size(job_.given.mesh, repair);
  RepairedPlc built = source_->build(repair, job_.execution());
  all.repair = std::move(built.report);
  if (all.repair.cancelled) job_.control.stop();
  all.plc = std::move(built.plc);
  maker_.take_new_complex();
}

/// Meshes a complex within the bound on vertices. Returns the outcome, and the reason if a guarantee was
/// missed, the refinement exploded or the complex was refused.
std::pair<Tries::End, std::string> Tries::attempt(const Plc& plc, std::exception_ptr& error) {
  try {
    maker_.make(plc, job_.given.mesh.seed);
    return {job_.made.guarantees_hold() ? End::holds : End::missed, job_.made.missed()};
  } catch (const Ended&) {
    if (!job_.hit_bound()) throw;
    exploded_at_ = job_.budget.most();
    return {End::exploded, describe_explosion(plc, job_.budget.most(), job_.made.result.where)};
  } catch (const FarTooFine& e) {
    most_asked_for_ = e.most;
    return {End::too_fine, {}};
  } catch (const PlcError& e) {
    error = std::current_exception();
    return {End::refused, e.what()};
  }
}

std::vector<RepairOptions> Tries::repairs_after(End end, const SoupPipelineResult& all) const {
  const PipelineOptions& given = job_.given;
  if (end == End::missed && misses_collar_angle_only()) return {};
  std::vector<RepairOptions> repairs = further_repairs(given.repair, all.repair);
  if (end == End::refused || (end == End::missed && !all.repair.repaired)) return repairs;
  if (end == End::exploded || maker_.was_far_too_fine())
    std::erase_if(repairs, [](const RepairOptions& repair) { return !repair.wrap_at_once; });
  const double diagonal = all.plc.bounds.diagonal();
  std::vector<RepairOptions> coarser =
      coarser_repairs(given.repair, smallest_size(given.mesh, diagonal), diagonal);
  const auto wraps = [](const RepairOptions& repair) { return repair.wrap_at_once; };
  repairs.insert(std::ranges::find_if(repairs, wraps), coarser.begin(), coarser.end());
  return repairs;
}

/// Returns whether only angles in collars miss their bound. These depend on creases, which repair does not
/// change.
bool Tries::misses_collar_angle_only() const {
  return job_.made.result.status == MeshStatus::complete &&
         std::ranges::all_of(job_.made.check.findings, [](const Finding& finding) {
           return finding.guarantee == guarantee::collar_dihedral;
         });
}

bool Tries::missed(const char* guarantee) const {
  return std::ranges::any_of(job_.made.check.findings,
                             [&](const Finding& finding) { return finding.guarantee == guarantee; });
}

/// If angles miss their bounds, as in places far thinner than the size, tries constrained tetrahedra. Then
/// tries further seeds until every guarantee holds: if refinement does not end at some place with the random
/// samples of one seed, it may end with those of another. If regions do not keep their volumes, also reduces
/// the surface distance.
void Tries::try_seeds(const Plc& plc) {
  if (!maker_.depends_on_seed()) return;
  PipelineResult& made = job_.made;
  if (missed(guarantee::thin_angles) && take_constrained(plc)) return;
  const std::uint64_t first = job_.given.mesh.seed;
  for (std::uint64_t seed = first + 1; seed < first + job_.given.seeds && !made.guarantees_hold(); ++seed) {
    const std::string missed = made.missed();
    if (const double share = share_for_volumes(); share < 1) maker_.come_nearer(plc, share);
    if (!find_better(true, [&] { maker_.make(plc, seed); })) continue;
    seed_ = seed;
    made.check.notes.push_back(
        fmt::format("made with seed {}, because with seed {}: {}", seed, first, missed));
  }
  try_narrow_places_otherwise(plc);
}

/// Uses constrained tetrahedra if they keep every guarantee; otherwise keeps the mesh.
bool Tries::take_constrained(const Plc& plc) {
  const std::string why = job_.made.missed();
  return find_better(true, [&] {
    if (!maker_.take_constrained(plc, why)) throw Hopeless();
  });
}

/// If angles still miss their bounds, tries the opposite treatment of narrow places. If the radius-edge
/// ratios of cells there were not bounded, cells may have large angles; so now bounds these ratios, unless
/// that takes many times the vertices. If the ratios were bounded, leaves them unbounded.
void Tries::try_narrow_places_otherwise(const Plc& plc) {
  constexpr std::size_t times = 10, more = 100'000;
  if (!job_.given.coarsen || !missed(guarantee::thin_angles)) return;
  PipelineResult& made = job_.made;
  const std::string missed = made.missed();
  const bool were_left = made.result.has_narrow_cells;
  const std::size_t before = job_.budget.most();
  if (were_left) {
    std::size_t most = times * made.result.statistics.vertices_inserted + more;
    for (const std::size_t bound : {before, job_.given.mesh.max_vertices})
      if (bound > 0) most = std::min(most, bound);
    job_.budget.set_most(most);
  }
  const NarrowCells otherwise = were_left ? NarrowCells::bounded : NarrowCells::left;
  maker_.set_narrow_cells(otherwise);
  if (find_better(true, [&] { maker_.make(plc, job_.given.mesh.seed); })) {
    seed_ = job_.given.mesh.seed;
    narrow_cells_ = otherwise;
    made.check.notes.push_back(
        fmt::format("made with {} narrow places, because otherwise: {}",
                    were_left ? "a bounded radius-edge ratio in" : "any radius-edge ratio in", missed));
  }
  job_.budget.set_most(before);
  maker_.set_narrow_cells(NarrowCells::bounded_if_cheap);
}

/// Returns the factor of the surface distance of first order with which regions should keep their volumes,
/// and thin places their thickness. The loss of volume is about proportional to the distance.
double Tries::share_for_volumes() const {
  constexpr double aim = 0.7, least = 0.25;
  const PipelineOptions& given = job_.given;
  const double allowed = volume_allowance(static_cast<int>(given.order));
  double share = 1;
  if (given.mesh.bounds.distance > 0 || given.mesh.bounds.tolerance)
    return share;  // the options give the distance
  const ShapeMeasures &input = job_.made.check.of_input, &mesh = job_.made.check.of_mesh;
  const auto keep = [&](double wanted, double found) {
    if (const double off = std::fabs(found - wanted); off > allowed * wanted)
      share = std::min(share, std::max(least, aim * allowed * wanted / off));
  };
  for (std::size_t r = 1; r < std::min(input.volumes.size(), mesh.volumes.size()); ++r)
    keep(input.volumes[r], mesh.volumes[r]);
  for (std::size_t i = 0; i < std::min(input.shells.size(), mesh.shells.size()); ++i)
    keep(input.shells[i], mesh.shells[i]);
  if (missed(guarantee::thickness_kept)) share = least;
  return share;
}

/// Returns the largest relative deviation of a region's volume from the input's. If `shares` is given (shares
/// of the tolerance, by patch), lowers those of the patches around each region whose volume calls for a
/// warning, so that this volume may come within the limit.
double Tries::largest_loss(const Plc& plc, std::vector<double>* shares) const {
  constexpr double aim = 0.7, least = 0.25;
  const ShapeMeasures &input = job_.made.check.of_input, &mesh = job_.made.check.of_mesh;
  double largest = 0;
  for (Index r = 1; r < std::min(input.volumes.size(), mesh.volumes.size()); ++r) {
    if (!(input.volumes[r] > 0)) continue;
    const double off = std::fabs(mesh.volumes[r] / input.volumes[r] - 1);
    largest = std::max(largest, off);
    if (shares == nullptr || off <= volume_warned_of) continue;
    const double share = std::max(least, aim * volume_warned_of / off);
    for (Index p = 0; p < plc.patches.size(); ++p)
      if (std::ranges::count(plc.patches[p].regions, r) == 1) (*shares)[p] = std::min((*shares)[p], share);
  }
  return largest;
}

/// Returns whether the kept mesh is small, keeps every guarantee, and has the default distances of first
/// order, no layers and no periodic faces. It must not consist of rings around rods, and its refinement must
/// not have hit the bound on vertices.
bool Tries::may_keep_volumes() const {
  constexpr std::size_t most_tets = 100'000;
  const PipelineOptions& given = job_.given;
  return given.order == 1 && given.start != Start::constrained && !(given.mesh.bounds.distance > 0) &&
         !given.mesh.bounds.tolerance && !given.layers.any() && !given.periodic.any() && exploded_at_ == 0 &&
         (maker_.depends_on_seed() || maker_.prefers_constrained()) && job_.made.guarantees_hold() &&
         job_.made.result.mesh.tets.size() <= most_tets;
}

/// Makes the mesh again, nearer to the surfaces of regions whose volumes call for a warning. This cannot be
/// done at first: the volumes that chords take from one side of a wall and add on the other cancel only in
/// part, and no estimate from the complex predicts how far they do. Keeps the mesh with the better volumes.
/// Each attempt gets half of the remaining time, so that a time limit cannot lose the mesh at hand.
void Tries::keep_volumes(const Plc& plc) {
  constexpr unsigned rounds = 2;
  constexpr double share_of_time = 0.5;
  for (unsigned round = 0; round < rounds && may_keep_volumes(); ++round) {
    std::vector<double> shares(plc.patches.size(), 1);
    const double loss = largest_loss(plc, &shares);
    if (loss <= volume_warned_of) return;
    bool better = false;
    job_.control.attempt(share_of_time, [&] { better = come_nearer(plc, shares, loss); });
    if (!better) return;
  }
}

/// Makes the mesh again with these shares of the tolerance. Keeps it if no volume calls for a warning, or if
/// the loss of the mesh at hand is halved with at most twice the tets. Returns whether it is kept.
bool Tries::come_nearer(const Plc& plc, const std::vector<double>& shares, double loss) {
  constexpr std::size_t times_tets = 2;
  const std::size_t tets = job_.made.result.mesh.tets.size();
  return make_nearer(plc, shares, fmt::format("a region's volume was off by {:.2g}%", 100 * loss), [&] {
    const double now = largest_loss(plc, nullptr);
    const bool is_halved = 2 * now <= loss && job_.made.result.mesh.tets.size() <= times_tets * tets;
    return now <= volume_warned_of || is_halved;
  });
}

/// If only volumes and thicknesses miss their limits, makes the mesh again, nearer to the smooth patches
/// concerned, in at most half of the remaining time. Returns whether every guarantee holds then.
bool Tries::come_nearer_where_missed(const Plc& plc) {
  constexpr double least = 0.25, share_of_time = 0.5;
  const CheckReport& check = job_.made.check;
  const Bounds& bounds = job_.given.mesh.bounds;
  if (job_.given.order != 1 || bounds.distance > 0 || bounds.tolerance || !misses_volumes_only(check))
    return false;
  std::vector<double> shares(plc.patches.size(), 1);
  largest_loss(plc, &shares);
  for (const Finding& finding : check.findings)
    if (finding.guarantee == guarantee::thickness_kept)
      for (const Index patch : finding.ids) shares[patch] = std::min(shares[patch], least);
  if (std::ranges::all_of(shares, [](double share) { return share >= 1; })) return false;
  bool holds = false;
  job_.control.attempt(share_of_time, [&] {
    holds = make_nearer(plc, shares, "otherwise: " + job_.made.missed(), [] { return true; });
  });
  return holds;
}

/// Makes the mesh again with these shares of the tolerance, by patch, and at most a few times its number of
/// vertices or, if it began with constrained tetrahedra, of tets. Uses the new mesh if it keeps every
/// guarantee and `is_good_enough` returns true. Returns whether it is used. `why`: the reason that a note
/// gives.
bool Tries::make_nearer(const Plc& plc, const std::vector<double>& shares, const std::string& why,
                        const std::function<bool()>& is_good_enough) {
  constexpr std::size_t times_vertices = 3, times_tets = 3;
  PipelineResult& made = job_.made;
  std::vector<std::string> notes = made.check.notes;
  const bool constrained = maker_.prefers_constrained();
  const std::size_t most_tets = constrained ? times_tets * made.result.mesh.tets.size() : none;
  const std::size_t before = job_.budget.most();
  std::size_t most = times_vertices * made.result.statistics.vertices_inserted;
  for (const std::size_t bound : {before, job_.given.mesh.max_vertices})
    if (bound > 0) most = std::min(most, bound);
  if (!constrained && most > 0) job_.budget.set_most(most);
  maker_.set_narrow_cells(narrow_cells_);
  maker_.come_nearer(plc, shares);
  const bool better = find_better(true, [&] {
    maker_.make_again(plc, seed_);
    if (made.result.mesh.tets.size() > most_tets || !is_good_enough()) throw Hopeless();
  });
  job_.budget.set_most(before);
  maker_.set_narrow_cells(NarrowCells::bounded_if_cheap);
  if (!better) return false;
  // The maker has written its own notes again.
  std::erase_if(notes, [&](const std::string& note) {
    return (constrained && note.starts_with("made with seed")) ||
           std::ranges::count(made.check.notes, note) > 0;
  });
  made.check.notes.insert(made.check.notes.begin(), notes.begin(), notes.end());
  made.check.notes.push_back("made nearer to smooth surfaces, because " + why);
  return true;
}

template <class Way>
bool Tries::find_better(bool has_mesh, const Way& way) {
  PipelineResult& made = job_.made;
  PipelineResult kept = std::exchange(made, {});
  const bool kept_is_constrained = maker_.is_constrained();
  bool better = false;
  const auto fails = [&] {
    if ((!has_mesh && !job_.hit_bound()) || made.result.status == MeshStatus::cancelled) throw;
  };
  try {
    way();
    better = !has_mesh || made.guarantees_hold();
  } catch (const PlcError&) {
    better = false;
  } catch (const Hopeless&) {
    better = false;
  } catch (const FarTooFine&) {
    better = false;
  } catch (const OptionError&) {  // a tag with a size may not exist in the other complex
    better = false;
  } catch (const Ended&) {
    fails();
  } catch (const std::bad_alloc&) {
    fails();
  }
  if (!better) {
    made = std::move(kept);
    maker_.set_constrained(kept_is_constrained);
  }
  return better;
}

}  // namespace collarmesh::pipeline
