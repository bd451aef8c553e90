// The certificate: each guarantee recomputed from the DMPlex and the complex alone. Each rank judges its own
// cells; the owner judges points that ranks share.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include "calls.h"
#include "check/feature_sizes.h"
#include "check/nodes_on_feature.h"
#include "check/predicates.h"
#include "collarmesh/distributed.h"
#include "common/sorted.h"
#include "common/split_mix.h"
#include "local_mesh.h"
#include "shared_points.h"

namespace collarmesh::distributed {

namespace {

using checks::At;

constexpr checks::Measure length_of_curve{"curve_length", "length", "Edges are missing or doubled."};

/// A hash that does not depend on the order of cells: two sums of numbers made from the cells.
class Fingerprint {
 public:
  static std::uint64_t of(const Point& p) {
    std::uint64_t h = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      h = mixed(split_mix_step + (h ^ std::bit_cast<std::uint64_t>(p[axis] + 0.0)));
    return h;
  }
  template <std::size_t n>
  void add(std::array<std::uint64_t, n> points, std::uint64_t label) {
    std::sort(points.begin(), points.end());
    for (std::size_t s = 0; s < sums_.size(); ++s) {
      std::uint64_t h = mixed(split_mix_step + label + (s + 1) * n);
      for (const std::uint64_t p : points) h = mixed(split_mix_step + (h ^ p));
      sums_[s] += h;
    }
  }
  const std::array<std::uint64_t, 2>& sums() const { return sums_; }

 private:
  std::array<std::uint64_t, 2> sums_{};
};

/// Returns the input of the checks with an empty mesh: the complex, and the allowed distances of a mesh from
/// it.
checks::MeshToCheck mesh_to_check_of(const Shape& shape, const TetMesh& nothing) {
  CheckOptions options;
  options.bounds.tolerance = SurfaceTolerance(shape.distance);
  return checks::make_mesh_to_check(nothing, shape.plc, options);
}

/// The measures of the complex's features, and by how much those of the mesh may differ.
struct Expected {
  explicit Expected(const Shape& shape)
      : to_check(mesh_to_check_of(shape, nothing)), sizes(measures_of(shape.plc)) {
    const Plc& plc = shape.plc;
    for (Index c = 0; c < plc.curves.size(); ++c) measure_turn(plc, c);
    for (Index p = 0; p < plc.patches.size(); ++p) {
      const auto [area, room] =
          plc.patches[p].planar ? checks::planar_area(to_check, p) : smooth_area(plc, p);
      sizes.areas[p] = area;
      area_room.push_back(room);
    }
    const checks::RegionVolumes of_regions = checks::expected_volumes(to_check);
    for (Index r = 1; r < plc.regions.size(); ++r) {
      volumes[plc.regions[r].tag] += of_regions.enclosed[r];
      volume_room[plc.regions[r].tag] += of_regions.allowed[r];
    }
    for (auto& [tag, room] : volume_room) room += 1e-9 * std::fabs(volumes[tag]);
  }
  Expected(const Expected&) = delete;
  Expected& operator=(const Expected&) = delete;

  TetMesh nothing;
  checks::MeshToCheck to_check;
  ShapeMeasures sizes;
  std::vector<double> length_room, area_room;  ///< allowed differences, by curve and by patch
  std::map<Tag, double> volumes, volume_room;

 private:
  // Measures by how much a curve turns. If points of a curve move by at most d, its length changes by at most
  // d times the angle by which it turns, to first order (Steiner's formula), and by d at each end. Twice the
  // first term is allowed. An inscribed polygon turns by about as much as the curve that it approximates. For
  // patches (`smooth_area`), angles between triangles times the lengths of their common edges are summed.
  void measure_turn(const Plc& plc, Index c) {
    const Plc::Curve& curve = plc.curves[c];
    const std::vector<Index>& chain = curve.points;
    double turn = 0;
    const std::size_t segments = chain.size() - (curve.closed ? 0 : 1);
    const auto segment = [&](std::size_t i) {
      return plc.points[chain[(i + 1) % chain.size()]] - plc.points[chain[i % chain.size()]];
    };
    for (std::size_t i = 0; i < segments; ++i)
      if (i + 1 < segments || curve.closed) turn += angle(segment(i), segment((i + 1) % segments));
    length_room.push_back(1e-9 * sizes.lengths[c] +
                          to_check.curve_allowance[c] * ((curve.straight ? 0 : 2 * turn) + 2));
  }

  checks::AllowedArea smooth_area(const Plc& plc, Index p) const {
    const Plc::Patch& patch = plc.patches[p];
    double turn = 0;
    std::map<std::array<Index, 2>, std::pair<double, Vector>> sides;  // length, and normal of the first
                                                                      // triangle
    for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t) {
      const auto& q = plc.triangles[t].points;
      const Point &a = plc.points[q[0]], &b = plc.points[q[1]], &c = plc.points[q[2]];
      const Vector normal = cross(b - a, c - a);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [side, is_new] = sides.try_emplace(
            sorted(q[k], q[(k + 1) % 3]), distance(plc.points[q[k]], plc.points[q[(k + 1) % 3]]), normal);
        if (!is_new) turn += side->second.first * angle(side->second.second, normal);
      }
    }
    double room = 1e-9 * sizes.areas[p] + 2 * to_check.patch_allowance[p] * turn;
    for (const Index c : patch.curves) room += to_check.curve_allowance[c] * sizes.lengths[c];
    return {sizes.areas[p], room};
  }

  static double angle(const Vector& u, const Vector& v) { return std::atan2(norm(cross(u, v)), dot(u, v)); }
};

class Certification {
 public:
  Certification(DM dm, int order, const Shape& shape, const AngleBounds& allowed)
      : dm_(dm),
        communicator_(PetscObjectComm(reinterpret_cast<PetscObject>(dm))),
        order_(order),
        shape_(shape),
        plc_(shape.plc),
        allowed_(allowed),
        vertices_(dm, 0),
        edges_(dm, 1),
        faces_(dm, 2) {}

  Certificate run() {
    agree(communicator_, [&] {
      mesh_.emplace(dm_, order_);
      expected_.emplace(shape_);
    });
    check_shared_places();
    agree(communicator_, [&] { check_tets(); });
    find_sides();
    agree(communicator_, [&] {
      check_faces();
      check_edges();
      check_points();
    });
    check_chains();
    sum_up();
    compare_with_complex();
    gather();
    return std::move(certificate_);
  }

 private:
  template <class... Arguments>
  void find(std::string_view guarantee, const Point& where, fmt::format_string<Arguments...> message,
            Arguments&&... arguments) {
    findings_.add(guarantee, where, {}, message, std::forward<Arguments>(arguments)...);
  }

  /// Returns whether this rank judges a point. The vertices come first, then the nodes of edges.
  bool owns(std::size_t point) const {
    return point < mesh_->vertices ? vertices_.owned(point) : edges_.owned(point - mesh_->vertices);
  }
  static bool is_corner(const TetMesh::VertexFeature& feature) { return feature.dimension == 0; }

  /// Checks that points which ranks share have the same coordinates on each rank, bit by bit.
  void check_shared_places() {
    const std::vector<Point>& points = mesh_->points;
    std::vector<Point> owners = points;
    vertices_.take_owners(std::span(owners).first(mesh_->vertices));
    if (order_ == 2) edges_.take_owners(std::span(owners).subspan(mesh_->vertices));
    for (std::size_t i = 0; i < points.size(); ++i)
      if (points[i] != owners[i])
        find("shared_places", points[i],
             "A {} that is at {} on this rank is elsewhere on the rank that owns it.",
             i < mesh_->vertices ? "vertex" : "mid-edge node", At{points[i]});
  }

  void check_tets() {
    certificate_.tets = static_cast<std::int64_t>(mesh_->tets.size());
    for (Index t = 0; t < mesh_->tets.size(); ++t) {
      const Corners p = mesh_->corners(t);
      const Point centre = 0.25 * (p[0] + p[1] + p[2] + p[3]);
      const Tag tag = mesh_->tet_tag[t];
      const TetQuality quality = measure_tet(*mesh_, t);
      if (!checks::check_orientation({"Tet"}, p, quality.volume, findings_)) continue;
      if (!expected_->volumes.contains(tag)) {
        find(guarantee::region_tag, centre,
             "A tet at {} is labelled with region {}, which the complex does not have.", At{centre}, tag);
        continue;
      }
      if (order_ == 2) checks::check_jacobian({"Tet"}, curved_tet(*mesh_, t), tag, findings_);
      certificate_.region_volumes[tag] += quality.volume;
      check_angles(quality, mesh_->tet_collar[t] != 0, centre);
      std::array<std::uint64_t, 4> corners;
      for (std::size_t k = 0; k < 4; ++k) corners[k] = Fingerprint::of(p[k]);
      const unsigned collar = mesh_->tet_collar[t];
      fingerprint_.add(corners, mixed(static_cast<std::uint64_t>(tag)) + (collar == 0 ? 0 : collar + 1));
    }
  }

  void check_angles(const TetQuality& quality, bool in_collar, const Point& centre) {
    certificate_.angles.add(quality, in_collar);
    const double least = allowed_.least[in_collar], most = allowed_.most[in_collar];
    if (quality.min_dihedral < least || quality.max_dihedral > most)
      find("dihedral_angles", centre,
           "A tet at {}{} has dihedral angles from {:.4g} to {:.4g} degrees, allowed are {:.4g} to {:.4g}.",
           At{centre}, in_collar ? " in a collar" : "", quality.min_dihedral, quality.max_dihedral, least,
           most);
  }

  /// Finds the number of tets at each face, and the least and greatest tag of their regions.
  void find_sides() {
    const std::size_t n = faces_.size();
    tets_of_.assign(n, 0);
    least_region_.assign(n, std::numeric_limits<PetscInt>::max());
    most_region_.assign(n, -1);
    PetscInt first_tet = 0;
    call(DMPlexGetHeightStratum(dm_, 0, &first_tet, nullptr));
    for (std::size_t t = 0; t < mesh_->tets.size(); ++t) {
      const PetscInt* faces = nullptr;
      call(DMPlexGetCone(dm_, first_tet + static_cast<PetscInt>(t), &faces));
      const auto region = static_cast<PetscInt>(mesh_->tet_tag[t]);
      for (std::size_t k = 0; k < 4; ++k) {
        const auto f = static_cast<std::size_t>(faces[k] - faces_.first());
        ++tets_of_[f];
        least_region_[f] = std::min(least_region_[f], region);
        most_region_[f] = std::max(most_region_[f], region);
      }
    }
    faces_.combine(tets_of_, MPI_SUM);
    faces_.combine(least_region_, MPI_MIN);
    faces_.combine(most_region_, MPI_MAX);
  }

  PetscInt tag_of(Index region) const {
    return region == 0 ? -1 : static_cast<PetscInt>(plc_.regions[region].tag);
  }

  void check_faces() {
    areas_.assign(plc_.patches.size(), 0);
    Index listed = 0;  // the next face on a patch
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const bool on_patch = listed < mesh_->faces.size() && mesh_->face_number[listed] == f;
      const Index face = on_patch ? listed++ : none;
      const bool inside = tets_of_[f] == 2 && least_region_[f] == most_region_[f];
      if (!faces_.owned(f) || (!on_patch && inside)) continue;
      const auto& [a, b, c] =
          on_patch ? mesh_->faces[face] : corners_of_face(dm_, faces_.first() + static_cast<PetscInt>(f));
      const Point centre = (mesh_->points[a] + mesh_->points[b] + mesh_->points[c]) / 3;
      if (tets_of_[f] != 1 && tets_of_[f] != 2)
        find(guarantee::conforming, centre, "A face at {} has {} tets; it may have one or two.", At{centre},
             tets_of_[f]);
      if (!on_patch) {
        find(guarantee::watertight, centre, "A face at {} {} but lies on no patch.", At{centre},
             tets_of_[f] == 1 ? "has one tet only" : "lies between two regions");
        continue;
      }
      ++certificate_.faces;
      const Index patch = mesh_->face_patch[face];
      check_regions(f, patch, centre);
      areas_[patch] += area_on(plc_.patches[patch], face);
      fingerprint_.add(std::array{Fingerprint::of(mesh_->points[a]), Fingerprint::of(mesh_->points[b]),
                                  Fingerprint::of(mesh_->points[c])},
                       patch);
    }
  }

  void check_regions(std::size_t f, Index patch, const Point& centre) {
    const auto& [back, front] = plc_.patches[patch].regions;
    const std::pair<PetscInt, PetscInt> wanted = std::minmax(tag_of(back), tag_of(front));
    const PetscInt least = tets_of_[f] == 1 ? -1 : least_region_[f];
    if (least == wanted.first && most_region_[f] == wanted.second) return;
    find(guarantee::face_regions, centre,
         "A face at {} on patch {} (tag {}) lies between the regions {} and {}, but the patch between {} and "
         "{} (-1 is outside).",
         At{centre}, patch, plc_.patches[patch].tag, least, most_region_[f], wanted.first, wanted.second);
  }

  // Measures a face. Triangles on planar patches are measured by their projections, as the patches are.
  double area_on(const Plc::Patch& patch, Index face) const {
    if (!patch.planar) return checks::area_of_face(*mesh_, face);
    const auto place = [&](Index i) {
      const Point& p = mesh_->points[i];
      return p - dot(p - patch.origin, patch.normal) * patch.normal;
    };
    const auto& [a, b, c] = mesh_->faces[face];
    if (order_ == 1) return checks::area(place(a), place(b), place(c));
    const auto& [ab, bc, ca] = mesh_->face_mid_nodes[face];
    return area(CurvedTriangle{place(a), place(b), place(c), place(ab), place(bc), place(ca)});
  }

  void check_edges() {
    lengths_.assign(plc_.curves.size(), 0);
    const auto ends_of = [&](const std::array<Index, 2>& ends) {
      return std::array{Fingerprint::of(mesh_->points[ends[0]]), Fingerprint::of(mesh_->points[ends[1]])};
    };
    for (std::size_t e = 0; order_ == 2 && e < edges_.size(); ++e)
      if (edges_.owned(e))
        fingerprint_.add(ends_of(mesh_->ends[e]), Fingerprint::of(mesh_->points[mesh_->vertices + e]));
    for (Index e = 0; e < mesh_->edges.size(); ++e) {
      if (!edges_.owned(mesh_->edge_number[e])) continue;
      ++certificate_.edges;
      fingerprint_.add(ends_of(mesh_->edges[e]), mesh_->edge_curve[e]);
      lengths_[mesh_->edge_curve[e]] += checks::length_of_edge(*mesh_, e);
    }
  }

  void check_points() {
    std::map<PetscInt, checks::NodesOnFeature> features;  // by the feature's code in the label
    for (std::size_t i = 0; i < mesh_->points.size(); ++i) {
      if (!owns(i)) continue;
      const Point& p = mesh_->points[i];
      const TetMesh::VertexFeature& feature = mesh_->features[i];
      if (i < mesh_->vertices) ++certificate_.vertices;
      if (is_corner(feature)) corners_.push_back(p);
      if (feature.dimension != 1 && feature.dimension != 2) continue;
      features.try_emplace(encoded(feature), expected_->to_check, feature)
          .first->second.check(feature.dimension == 1 ? guarantee::curve_distance : guarantee::patch_distance,
                               {i < mesh_->vertices ? "The vertex" : "The mid-edge node"}, p,
                               certificate_.largest_distance, findings_);
    }
  }

  /// Checks that two edges of the curve meet at every vertex inside a curve.
  void check_chains() {
    std::vector<PetscInt> edges_of(mesh_->vertices, 0);
    for (std::size_t e = 0; e < mesh_->edges.size(); ++e) {
      if (!edges_.owned(mesh_->edge_number[e])) continue;
      for (const Index v : mesh_->edges[e])
        if (mesh_->features[v].dimension == 1 && mesh_->features[v].feature == mesh_->edge_curve[e])
          ++edges_of[v];
    }
    vertices_.combine(edges_of, MPI_SUM);
    for (std::size_t v = 0; v < edges_of.size(); ++v)
      if (const auto [dimension, curve] = mesh_->features[v]; vertices_.owned(v) && dimension == 1)
        checks::check_edges_at({"curve", curve, plc_.curves[curve].tag}, mesh_->points[v], edges_of[v], 2,
                               findings_);
  }

  void sum(std::vector<double>& values) const {
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM,
                  communicator_);
  }

  void sum_up() {
    Certificate& c = certificate_;
    c.tets_of_ranks = gathered(communicator_, std::vector{c.tets});
    for (std::int64_t* value : {&c.tets, &c.vertices, &c.faces, &c.edges})
      *value = all_reduce(communicator_, *value, MPI_SUM);
    for (std::size_t kind = 0; kind < 2; ++kind) {
      c.angles.least[kind] = all_reduce(communicator_, c.angles.least[kind], MPI_MIN);
      c.angles.most[kind] = all_reduce(communicator_, c.angles.most[kind], MPI_MAX);
    }
    c.largest_distance = all_reduce(communicator_, c.largest_distance, MPI_MAX);
    std::vector<double> volumes;
    for (const auto& [tag, volume] : expected_->volumes) volumes.push_back(c.region_volumes[tag]);
    sum(volumes);
    sum(areas_);
    sum(lengths_);
    std::size_t i = 0;
    for (const auto& [tag, volume] : expected_->volumes) c.region_volumes[tag] = volumes[i++];
    for (Index p = 0; p < areas_.size(); ++p) c.patch_areas[plc_.patches[p].tag] += areas_[p];
    for (Index k = 0; k < lengths_.size(); ++k) c.curve_lengths[plc_.curves[k].tag] += lengths_[k];
    for (std::size_t s = 0; s < 2; ++s)
      c.fingerprint[s] = all_reduce(communicator_, fingerprint_.sums()[s], MPI_SUM);
  }

  /// Compares the sums with the complex; only rank 0 does so. Leaves out features outside all regions, which
  /// the mesh does not have.
  void compare_with_complex() {
    TetMesh found;
    found.points = gathered(communicator_, corners_);
    if (Ranks(communicator_).rank != 0) return;
    checks::MeshToCheck& to_check = expected_->to_check;
    to_check.match.vertex_point = checks::match_vertices(found, plc_, to_check.rounding);
    checks::check_vertices_present(to_check, findings_);
    const auto compare = [&](const checks::Measure& measure, const checks::NamedFeature& feature,
                             double measured, double expected, double allowed) {
      checks::check_measure(measure, feature, plc_.bounds.centre(), measured, expected, allowed, findings_);
    };
    for (const auto& [tag, wanted] : expected_->volumes)
      compare(checks::volume_of_region, {"region", none, tag}, certificate_.region_volumes[tag], wanted,
              expected_->volume_room[tag]);
    for (Index p = 0; p < areas_.size(); ++p)
      if (!checks::patch_is_outside(to_check, p))
        compare(checks::area_of_patch, {"patch", p, plc_.patches[p].tag}, areas_[p],
                expected_->sizes.areas[p], expected_->area_room[p]);
    for (Index k = 0; k < lengths_.size(); ++k)
      if (!checks::curve_is_outside(to_check, k))
        compare(length_of_curve, {"curve", k, plc_.curves[k].tag}, lengths_[k], expected_->sizes.lengths[k],
                expected_->length_room[k]);
  }

  /// Gives every rank the findings of all ranks.
  void gather() {
    std::string own;
    for (const auto& finding : found_.findings) own += finding.guarantee + '\t' + finding.message + '\n';
    const std::string all = gathered(communicator_, own);
    for (std::size_t at = 0; at < all.size();) {
      const std::size_t tab = all.find('\t', at), end = all.find('\n', at);
      certificate_.findings.push_back({all.substr(at, tab - at), all.substr(tab + 1, end - tab - 1)});
      at = end + 1;
    }
    std::stable_sort(certificate_.findings.begin(), certificate_.findings.end(),
                     [](const Finding& a, const Finding& b) { return a.guarantee < b.guarantee; });
    certificate_.findings_total =
        all_reduce(communicator_, static_cast<std::int64_t>(found_.findings_total), MPI_SUM);
  }

  DM dm_;
  MPI_Comm communicator_;
  int order_;
  const Shape& shape_;
  const Plc& plc_;
  const AngleBounds& allowed_;
  SharedPoints vertices_, edges_, faces_;
  std::optional<LocalMesh> mesh_;
  std::optional<Expected> expected_;
  std::vector<PetscInt> tets_of_, least_region_, most_region_;  // by face: number of tets, least and greatest
                                                                // tag
  std::vector<double> areas_, lengths_;  // measured areas by patch and lengths by curve
  std::vector<Point> corners_;           // mesh vertices at vertices of the complex
  CheckReport found_;                    // findings of this rank
  checks::Findings findings_{found_, Certificate::listed};
  Fingerprint fingerprint_;
  Certificate certificate_;
};

}  // namespace

Certificate ParallelMesh::certify(const Shape& shape, double slack) const {
  const PetscMessages messages;
  AngleBounds allowed = coarse_angles_;
  for (double& least : allowed.least) least -= slack;
  for (double& most : allowed.most) most += slack;
  return Certification(dm_, order_, shape, allowed).run();
}

}  // namespace collarmesh::distributed
