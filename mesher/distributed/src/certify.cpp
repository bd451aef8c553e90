// The certificate: each guarantee recomputed from the DMPlex and the complex alone. Each rank judges its own
// cells; the owner judges points that ranks share.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>

#include "angles.h"
#include "calls.h"
#include "check/predicates.h"
#include "check/subject.h"
#include "collarmesh/curved_tet.h"
#include "collarmesh/distributed.h"
#include "common/sorted.h"
#include "common/split_mix.h"
#include "local_mesh.h"
#include "mid_nodes.h"
#include "on_shape.h"
#include "shared_points.h"

namespace collarmesh::distributed {

namespace {

using checks::At;

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

/// Returns the subject of the checks without a mesh: the complex, and the allowed distances of a mesh from
/// it.
checks::Subject subject_of(const Shape& shape, const TetMesh& nothing) {
  CheckOptions options;
  options.bounds.tolerance = SurfaceTolerance(shape.distance);
  return checks::make_subject(nothing, shape.plc, options);
}

/// The expected measures of the complex's features, and the allowed differences.
struct Expected {
  explicit Expected(const Shape& shape) : subject(subject_of(shape, nothing)), sizes(measures_of(shape.plc)) {
    const Plc& plc = shape.plc;
    for (Index p = 0; p < plc.patches.size(); ++p)
      if (plc.patches[p].planar) sizes.areas[p] = area_in_plane(plc, plc.patches[p]);
    for (Index c = 0; c < plc.curves.size(); ++c) measure_turn(plc, c);
    for (const Plc::Patch& patch : plc.patches) area_room.push_back(room_of(plc, patch));
    const checks::RegionVolumes of_regions = checks::expected_volumes(subject);
    for (Index r = 1; r < plc.regions.size(); ++r) {
      volumes[plc.regions[r].tag] += of_regions.enclosed[r];
      volume_room[plc.regions[r].tag] += of_regions.allowed[r];
    }
    for (auto& [tag, room] : volume_room) room += 1e-9 * std::fabs(volumes[tag]);
  }
  Expected(const Expected&) = delete;
  Expected& operator=(const Expected&) = delete;

  TetMesh nothing;
  checks::Subject subject;
  ShapeMeasures sizes;
  std::vector<double> length_room, area_room;  ///< allowed differences, by curve and by patch
  std::map<Tag, double> volumes, volume_room;

 private:
  // Returns the area of the triangles' projections onto the plane. It depends on the border alone, so it does
  // not matter if triangles of a patch that is planar up to a tolerance are tilted.
  static double area_in_plane(const Plc& plc, const Plc::Patch& patch) {
    double sum = 0;
    for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t) {
      const auto& [a, b, c] = plc.triangles[t].points;
      sum += 0.5 * dot(cross(plc.points[b] - plc.points[a], plc.points[c] - plc.points[a]), patch.normal);
    }
    return std::fabs(sum);
  }

  // Measures by how much a curve turns. If points of a feature move by d, its length or area changes by at
  // most d times the angle by which it turns, to first order (Steiner's formula), and by the moves of its
  // ends. An inscribed polygon turns by as much as the curve that it approximates.
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
                          subject.curve_allowance[c] * ((curve.straight ? 0 : 2 * turn) + 2));
  }

  double room_of(const Plc& plc, const Plc::Patch& patch) const {
    const std::size_t p = area_room.size();
    double turn = 0;
    std::map<std::array<Index, 2>, std::pair<double, Vector>> sides;  // length, and normal of the first
                                                                      // triangle
    for (Index t = patch.first_triangle; !patch.planar && t < patch.first_triangle + patch.triangle_count;
         ++t) {
      const auto& q = plc.triangles[t].points;
      const Point &a = plc.points[q[0]], &b = plc.points[q[1]], &c = plc.points[q[2]];
      const Vector normal = cross(b - a, c - a);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [side, is_new] = sides.try_emplace(
            sorted(q[k], q[(k + 1) % 3]), distance(plc.points[q[k]], plc.points[q[(k + 1) % 3]]), normal);
        if (!is_new) turn += side->second.first * angle(side->second.second, normal);
      }
    }
    double room = 1e-9 * sizes.areas[p] + 2 * subject.patch_allowance[p] * turn;
    for (const Index c : patch.curves) room += subject.curve_allowance[c] * sizes.lengths[c];
    return room;
  }

  static double angle(const Vector& u, const Vector& v) { return std::atan2(norm(cross(u, v)), dot(u, v)); }
};

class Certification {
 public:
  Certification(DM dm, int order, const Shape& shape, const AngleBounds& allowed)
      : dm_(dm),
        communicator_(PetscObjectComm(reinterpret_cast<PetscObject>(dm))),
        ranks_(communicator_),
        order_(order),
        shape_(shape),
        plc_(shape.plc),
        allowed_(allowed),
        vertices_(dm, 0),
        shared_edges_(dm, 1),
        shared_faces_(dm, 2) {}

  Certificate run() {
    agree(communicator_, [&] {
      read();
      expected_.emplace(shape_);
    });
    check_shared_places();
    agree(communicator_, [&] { check_tets(); });
    find_sides();
    agree(communicator_, [&] {
      check_faces();
      check_edges();
      check_vertices();
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

  void read() {
    mesh_.emplace(dm_);
    edges_.emplace(dm_);
    if (order_ == 2) nodes_ = edges_->nodes();
    PetscInt end = 0;
    call(DMPlexGetHeightStratum(dm_, 0, &first_tet_, &end));
    regions_ = label_values(dm_, "region", first_tet_, mesh_->tets.size());
    collars_ = label_values(dm_, "collar", first_tet_, mesh_->tets.size());
    vertex_codes_ = label_values(dm_, feature_label, vertices_.first(), mesh_->points.size());
    edge_codes_ = label_values(dm_, feature_label, shared_edges_.first(), edges_->size());
    face_codes_ = label_values(dm_, feature_label, shared_faces_.first(), shared_faces_.size());
    areas_.assign(plc_.patches.size(), 0);
    lengths_.assign(plc_.curves.size(), 0);
  }

  /// Checks that points which ranks share have the same coordinates on each rank, bit by bit.
  void check_shared_places() {
    const auto check = [&](const SharedPoints& points, const std::vector<Point>& places, const char* what) {
      const std::vector<std::size_t>& shared = points.shared();
      std::vector<PetscReal> values;
      for (const std::size_t i : shared)
        for (std::size_t axis = 0; axis < 3; ++axis) values.push_back(places[i][axis]);
      std::vector<PetscReal> owners = values;
      points.combine_shared(owners, MPI_REPLACE, 3);
      for (std::size_t k = 0; k < shared.size(); ++k)
        if (!std::equal(&values[3 * k], &values[3 * k] + 3, &owners[3 * k]))
          find("shared_places", places[shared[k]], "A {} at {} has another place on the rank that owns it.",
               what, At{places[shared[k]]});
    };
    check(vertices_, mesh_->points, "vertex");
    if (order_ == 2) check(shared_edges_, nodes_, "mid-side node");
  }

  void check_tets() {
    certificate_.tets = static_cast<std::int64_t>(mesh_->tets.size());
    for (std::size_t t = 0; t < mesh_->tets.size(); ++t) {
      const Corners p = mesh_->corners(t);
      const Point centre = 0.25 * (p[0] + p[1] + p[2] + p[3]);
      const auto tag = static_cast<Tag>(regions_[t]);
      if (regions_[t] < 0 || !expected_->volumes.contains(tag)) {
        find(guarantee::region_tag, centre,
             "A tet at {} has the label {} for its region, which the complex does not have.", At{centre},
             regions_[t]);
        continue;
      }
      double volume = six_volume(p[0], p[1], p[2], p[3]) / 6;
      if (!checks::check_orientation({"Tet"}, p, volume, findings_)) continue;
      if (order_ == 2) {
        const CurvedTet nodes =
            curved(p, edges_->of_tet(first_tet_ + static_cast<PetscInt>(t), mesh_->tets[t]), nodes_);
        volume = collarmesh::volume(nodes);
        checks::check_jacobian({"Tet"}, nodes, tag, findings_);
      }
      certificate_.region_volumes[tag] += volume;
      check_angles(t, p, centre);
      std::array<std::uint64_t, 4> corners;
      for (std::size_t k = 0; k < 4; ++k) corners[k] = Fingerprint::of(p[k]);
      fingerprint_.add(corners,
                       mixed(static_cast<std::uint64_t>(tag)) + static_cast<std::uint64_t>(collars_[t] + 1));
    }
  }

  void check_angles(std::size_t t, const Corners& p, const Point& centre) {
    const ExtremeAngles angles = extreme_angles(p);
    const std::size_t kind = collars_[t] > 0 ? 1 : 0;
    AngleBounds& all = certificate_.angles;
    all.least[kind] = std::min(all.least[kind], angles.least);
    all.most[kind] = std::max(all.most[kind], angles.most);
    if (angles.least < allowed_.least[kind] || angles.most > allowed_.most[kind])
      find("dihedral_angles", centre,
           "A tet at {}{} has dihedral angles from {:.4g} to {:.4g} degrees, allowed are {:.4g} to {:.4g}.",
           At{centre}, kind == 1 ? " in a collar" : "", angles.least, angles.most, allowed_.least[kind],
           allowed_.most[kind]);
  }

  /// Finds the number of tets at each face, and the least and greatest tag of their regions.
  void find_sides() {
    const std::size_t n = shared_faces_.size();
    tets_of_.assign(n, 0);
    least_region_.assign(n, std::numeric_limits<PetscInt>::max());
    most_region_.assign(n, -1);
    for (std::size_t t = 0; t < mesh_->tets.size(); ++t) {
      const PetscInt* faces = nullptr;
      call(DMPlexGetCone(dm_, first_tet_ + static_cast<PetscInt>(t), &faces));
      for (std::size_t k = 0; k < 4; ++k) {
        const auto f = static_cast<std::size_t>(faces[k] - shared_faces_.first());
        ++tets_of_[f];
        least_region_[f] = std::min(least_region_[f], regions_[t]);
        most_region_[f] = std::max(most_region_[f], regions_[t]);
      }
    }
    shared_faces_.combine(tets_of_, MPI_SUM);
    shared_faces_.combine(least_region_, MPI_MIN);
    shared_faces_.combine(most_region_, MPI_MAX);
  }

  PetscInt tag_of(Index region) const {
    return region == 0 ? -1 : static_cast<PetscInt>(plc_.regions[region].tag);
  }

  void check_faces() {
    for (std::size_t f = 0; f < shared_faces_.size(); ++f) {
      if (!shared_faces_.owned(f)) continue;
      const auto [dimension, patch] = decoded(face_codes_[f]);
      const bool on_patch = dimension == 2 && patch != none;
      const bool inside = tets_of_[f] == 2 && least_region_[f] == most_region_[f];
      if (!on_patch && inside) continue;
      const PetscInt face = shared_faces_.first() + static_cast<PetscInt>(f);
      const std::array<Index, 3> corners = corners_of_face(dm_, face, vertices_.first());
      const std::array<Point, 3> p{mesh_->points[corners[0]], mesh_->points[corners[1]],
                                   mesh_->points[corners[2]]};
      const Point centre = (p[0] + p[1] + p[2]) / 3;
      if (tets_of_[f] != 1 && tets_of_[f] != 2)
        find(guarantee::conforming, centre, "A face at {} has {} tets; it may have one or two.", At{centre},
             tets_of_[f]);
      if (!on_patch) {
        find(guarantee::watertight, centre, "A face at {} {} but lies on no patch.", At{centre},
             tets_of_[f] == 1 ? "has one tet only" : "lies between two regions");
        continue;
      }
      ++certificate_.faces;
      check_regions(f, patch, centre);
      measure_face(face, corners, p, patch);
      fingerprint_.add(std::array{Fingerprint::of(p[0]), Fingerprint::of(p[1]), Fingerprint::of(p[2])},
                       patch);
    }
  }

  void check_regions(std::size_t f, Index patch, const Point& centre) {
    const auto& [back, front] = plc_.patches[patch].regions;
    const std::pair<PetscInt, PetscInt> wanted = std::minmax(tag_of(back), tag_of(front));
    const PetscInt least = tets_of_[f] == 1 ? -1 : least_region_[f];
    if (least == wanted.first && most_region_[f] == wanted.second) return;
    find(guarantee::face_regions, centre,
         "A face at {} on patch {} (tag {}) lies between the regions {} and {}, the patch between {} and {} "
         "(-1 is outside).",
         At{centre}, patch, plc_.patches[patch].tag, least, most_region_[f], wanted.first, wanted.second);
  }

  // Measures a face. Triangles on planar patches are measured by their projections, as the patches are.
  void measure_face(PetscInt face, const std::array<Index, 3>& corners, const std::array<Point, 3>& p,
                    Index patch) {
    const Plc::Patch& on = plc_.patches[patch];
    const auto place = [&on](const Point& q) {
      return on.planar ? q - dot(q - on.origin, on.normal) * on.normal : q;
    };
    if (order_ == 1) {
      areas_[patch] += checks::area(place(p[0]), place(p[1]), place(p[2]));
      return;
    }
    const std::array<Index, 3> edges = edges_->of_face(face, corners);
    areas_[patch] +=
        collarmesh::area(CurvedTriangle{place(p[0]), place(p[1]), place(p[2]), place(nodes_[edges[0]]),
                                        place(nodes_[edges[1]]), place(nodes_[edges[2]])});
  }

  void check_edges() {
    for (std::size_t e = 0; e < edges_->size(); ++e) {
      if (!shared_edges_.owned(e)) continue;
      const auto& [a, b] = edges_->ends(e);
      const std::array ends{Fingerprint::of(mesh_->points[a]), Fingerprint::of(mesh_->points[b])};
      if (order_ == 2) fingerprint_.add(ends, Fingerprint::of(nodes_[e]));
      const auto [dimension, curve] = decoded(edge_codes_[e]);
      if (dimension != 1 || curve == none) continue;
      ++certificate_.edges;
      fingerprint_.add(ends, curve);
      lengths_[curve] += order_ == 1 ? distance(mesh_->points[a], mesh_->points[b])
                                     : length(CurvedEdge{mesh_->points[a], mesh_->points[b], nodes_[e]});
    }
  }

  void check_vertices() {
    OnShape on_shape(shape_);
    const checks::Subject& subject = expected_->subject;
    const auto check = [&](PetscInt code, const Point& p, const char* what) {
      const TetMesh::VertexFeature feature = decoded(code);
      const Index i = feature.feature;
      if (feature.dimension != 1 && feature.dimension != 2) return;
      const bool on_curve = feature.dimension == 1;
      const bool planar = !on_curve && plc_.patches[i].planar;
      const double off = planar ? std::fabs(dot(p - plc_.patches[i].origin, plc_.patches[i].normal))
                                : on_shape.distance_to_complex(feature, p);
      if (on_shape.is_smooth(feature))
        certificate_.largest_distance = std::max(certificate_.largest_distance, off);
      if (on_curve)
        checks::check_off_feature(guarantee::curve_distance, {what}, p, off, subject.curve_allowance[i],
                                  {"curve", i, plc_.curves[i].tag}, findings_);
      else
        checks::check_off_feature(guarantee::patch_distance, {what}, p, off, subject.patch_allowance[i],
                                  {"patch", i, plc_.patches[i].tag}, findings_);
    };
    for (std::size_t v = 0; v < mesh_->points.size(); ++v) {
      if (!vertices_.owned(v)) continue;
      ++certificate_.vertices;
      check(vertex_codes_[v], mesh_->points[v], "The vertex");
      if (vertex_codes_[v] == 0) corners_.push_back(mesh_->points[v]);
    }
    if (order_ == 2)
      for (std::size_t e = 0; e < edges_->size(); ++e)
        if (shared_edges_.owned(e)) check(edge_codes_[e], nodes_[e], "The mid-side node");
  }

  /// Checks that every vertex inside a curve has two edges on it.
  void check_chains() {
    std::vector<PetscInt> edges_of(mesh_->points.size(), 0);
    for (std::size_t e = 0; e < edges_->size(); ++e) {
      if (!shared_edges_.owned(e) || decoded(edge_codes_[e]).dimension != 1) continue;
      for (const Index v : edges_->ends(e))
        if (vertex_codes_[v] == edge_codes_[e]) ++edges_of[v];
    }
    vertices_.combine(edges_of, MPI_SUM);
    for (std::size_t v = 0; v < edges_of.size(); ++v)
      if (vertices_.owned(v) && decoded(vertex_codes_[v]).dimension == 1 && edges_of[v] != 2)
        find(guarantee::curve_cover, mesh_->points[v],
             "A vertex at {} on curve {} has {} edges on it, not 2.", At{mesh_->points[v]},
             decoded(vertex_codes_[v]).feature, edges_of[v]);
  }

  void sum(std::vector<double>& values) const {
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM,
                  communicator_);
  }

  void sum_up() {
    Certificate& c = certificate_;
    c.tets_of_ranks.resize(static_cast<std::size_t>(ranks_.count));
    MPI_Allgather(&c.tets, 1, MPI_INT64_T, c.tets_of_ranks.data(), 1, MPI_INT64_T, communicator_);
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

  bool in_regions(Index patch) const {
    const auto& [back, front] = plc_.patches[patch].regions;
    return back != 0 || front != 0;
  }

  /// Compares the sums with the complex; only rank 0 does so. Leaves out features outside all regions, which
  /// the mesh does not have.
  void compare_with_complex() {
    gather_corners();
    if (ranks_.rank != 0) return;
    const auto compare = [&](std::string_view guarantee, std::string_view what, Tag tag, double found,
                             double wanted, double room) {
      if (!(std::fabs(found - wanted) <= room))
        find(guarantee, plc_.bounds.centre(),
             "The {} tagged {} measures {:.15g}, that of the complex {:.15g}; allowed is {:.6g}.", what, tag,
             found, wanted, room);
    };
    for (const auto& [tag, wanted] : expected_->volumes)
      compare(guarantee::region_volume, "region", tag, certificate_.region_volumes[tag], wanted,
              expected_->volume_room[tag]);
    for (Index p = 0; p < areas_.size(); ++p)
      if (in_regions(p))
        compare(guarantee::patch_area, "patch", plc_.patches[p].tag, areas_[p], expected_->sizes.areas[p],
                expected_->area_room[p]);
    for (Index k = 0; k < lengths_.size(); ++k) {
      const auto& patches = plc_.curves[k].patches;
      if (std::any_of(patches.begin(), patches.end(), [&](Index p) { return in_regions(p); }))
        compare("curve_length", "curve", plc_.curves[k].tag, lengths_[k], expected_->sizes.lengths[k],
                expected_->length_room[k]);
    }
    check_vertices_of_complex();
  }

  void gather_corners() {
    std::vector<double> own, all;
    for (const Point& p : corners_) own.insert(own.end(), {p.x, p.y, p.z});
    const int size = static_cast<int>(own.size());
    std::vector<int> sizes(static_cast<std::size_t>(ranks_.count)), begins(sizes.size());
    MPI_Gather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, 0, communicator_);
    std::exclusive_scan(sizes.begin(), sizes.end(), begins.begin(), 0);
    all.resize(static_cast<std::size_t>(begins.back()) + static_cast<std::size_t>(sizes.back()));
    MPI_Gatherv(own.data(), size, MPI_DOUBLE, all.data(), sizes.data(), begins.data(), MPI_DOUBLE, 0,
                communicator_);
    if (ranks_.rank != 0) return;
    corners_.clear();
    for (std::size_t i = 0; i + 2 < all.size(); i += 3) corners_.push_back({all[i], all[i + 1], all[i + 2]});
  }

  void check_vertices_of_complex() {
    const auto less = [](const Point& a, const Point& b) {
      return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
    };
    std::sort(corners_.begin(), corners_.end(), less);
    std::vector<Index>& found = expected_->subject.match.vertex_point;
    found.clear();
    for (const Plc::Vertex& vertex : plc_.vertices) {
      const auto at = std::lower_bound(corners_.begin(), corners_.end(), plc_.points[vertex.point], less);
      const bool there = at != corners_.end() && *at == plc_.points[vertex.point];
      found.push_back(there ? static_cast<Index>(at - corners_.begin()) : none);
    }
    checks::check_vertices_present(expected_->subject, findings_);
  }

  /// Collects the findings of all ranks on all ranks.
  void gather() {
    std::string own;
    for (const auto& finding : found_.findings) own += finding.guarantee + '\t' + finding.message + '\n';
    const int size = static_cast<int>(own.size());
    std::vector<int> sizes(static_cast<std::size_t>(ranks_.count)), begins(sizes.size());
    MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, communicator_);
    std::exclusive_scan(sizes.begin(), sizes.end(), begins.begin(), 0);
    std::string all(static_cast<std::size_t>(begins.back()) + static_cast<std::size_t>(sizes.back()), ' ');
    MPI_Allgatherv(own.data(), size, MPI_CHAR, all.data(), sizes.data(), begins.data(), MPI_CHAR,
                   communicator_);
    certificate_.findings.clear();
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
  Ranks ranks_;
  int order_;
  const Shape& shape_;
  const Plc& plc_;
  const AngleBounds& allowed_;
  SharedPoints vertices_, shared_edges_, shared_faces_;
  std::optional<LocalMesh> mesh_;
  std::optional<Edges> edges_;
  std::optional<Expected> expected_;
  std::vector<Point> nodes_;  // mid-edge nodes
  PetscInt first_tet_ = 0;
  std::vector<PetscInt> regions_, collars_, vertex_codes_, edge_codes_, face_codes_;
  std::vector<PetscInt> tets_of_, least_region_, most_region_;  // by face: number of tets, least and greatest
                                                                // tag
  std::vector<double> areas_, lengths_;                         // measured areas by patch and lengths by
                                                                // curve
  std::vector<Point> corners_;                                  // mesh vertices at vertices of the complex
  CheckReport found_;                                           // findings of this rank
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
