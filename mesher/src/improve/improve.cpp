#include "collarmesh/improve.h"

#include <chrono>
#include <numbers>
#include <queue>

#include "collarmesh/error.h"
#include "improve/operations.h"
#include "improve/shape.h"
#include "improve/tet_complex.h"

namespace collarmesh {

namespace improvement {
namespace {

constexpr std::size_t steps_between_reports = 1024;
// An inserted vertex has to bring the tets around it to this share of the wanted quality.
constexpr double enough = 0.7;
constexpr double default_distance = 1e-3;

/// Works on the tets below a quality, worst first.
class Improvement {
 public:
  Improvement(TetMesh& mesh, const Plc& plc, const ImproveOptions& options, const Execution& execution)
      : complex_(mesh),
        operations_(complex_, plc, options.radius_edge,
                    options.distance > 0 ? options.distance : default_distance * plc.bounds.diagonal()),
        execution_(execution),
        move_vertices_(options.move_vertices),
        wanted_(std::sin(options.min_dihedral * std::numbers::pi / 180)),
        passes_(options.passes) {}

  ImproveReport run() {
    const auto started = std::chrono::steady_clock::now();
    for (Index t = 0; t < complex_.size(); ++t) queue(t);
    report_.candidates = queue_.size();
    for (unsigned pass = 0; pass < passes_ && !queue_.empty() && !report_.cancelled; ++pass) {
      const std::size_t before = changes();
      work_off();
      if (changes() == before) break;
      for (Index t = 0; t < complex_.size(); ++t) queue(t);
    }
    report_.remaining = count_remaining();
    complex_.store();
    report_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return report_;
  }

 private:
  struct Item {
    double quality;
    Index tet;
    std::uint32_t generation;

    friend bool operator<(const Item& a, const Item& b) {  // the worst on top
      return a.quality != b.quality ? a.quality > b.quality : a.tet > b.tet;
    }
  };

  std::size_t changes() const {
    return report_.edge_removals + report_.boundary_flips + report_.moved_vertices +
           report_.inserted_vertices + report_.contracted_edges;
  }

  std::size_t count_remaining() const {
    std::size_t count = 0;
    for (Index t = 0; t < complex_.size(); ++t)
      count += complex_[t].alive && !complex_[t].collar && operations_.quality(t) < wanted_;
    return count;
  }

  void queue(Index tet) {
    if (!complex_[tet].alive || complex_[tet].collar) return;
    const double quality = operations_.quality(tet);
    if (quality < wanted_) queue_.push({quality, tet, complex_[tet].generation});
  }

  void work_off() {
    std::size_t steps = 0;
    while (!queue_.empty()) {
      const Item item = queue_.top();
      queue_.pop();
      if (++steps % steps_between_reports == 0 && stopped()) {
        report_.cancelled = true;
        return;
      }
      const auto& tet = complex_[item.tet];
      if (!tet.alive || tet.generation != item.generation) continue;
      if (operations_.quality(item.tet) != item.quality) continue;  // a vertex has moved since
      help(item.tet);
    }
  }

  bool stopped() const {
    return execution_.cancelled() ||
           (execution_.progress &&
            !execution_.progress({"improve", 0, complex_.mesh().points.size(), complex_.size()}));
  }

  // The first of: an edge removed, corners moved, an edge contracted, a vertex inserted.
  void help(Index tet) {
    Change change;
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned j = i + 1; j < 4; ++j) operations_.remove_edge(tet, i, j, change);
    if (apply(change) || !move_vertices_) return;
    const auto corners = complex_[tet].corners;
    bool moved = false;
    for (const Index v : corners) {
      change = {};
      operations_.move_vertex(v, change);
      moved |= apply(change);
    }
    if (moved) return;
    for (const Index v : corners)
      for (const Index w : corners)
        if (v != w) operations_.contract_edge(v, w, change);
    if (apply(change) || report_.inserted_vertices >= report_.candidates) return;
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned j = i + 1; j < 4; ++j) {
        operations_.split_edge(corners[i], corners[j], enough * wanted_, change);
        if (apply(change)) return;
      }
  }

  bool apply(const Change& change) {
    switch (change.kind) {
      case Change::Kind::none: return false;
      case Change::Kind::edge_removal: ++report_.edge_removals; break;
      case Change::Kind::boundary_flip: ++report_.boundary_flips; break;
      case Change::Kind::move: ++report_.moved_vertices; break;
      case Change::Kind::insertion: ++report_.inserted_vertices; break;
      case Change::Kind::contraction: ++report_.contracted_edges; break;
    }
    for (const Index t : operations_.apply(change)) queue(t);
    return true;
  }

  TetComplex complex_;
  Operations operations_;
  const Execution& execution_;
  bool move_vertices_;
  double wanted_;
  unsigned passes_;
  std::priority_queue<Item> queue_;
  ImproveReport report_;
};

}  // namespace
}  // namespace improvement

ImproveOptions improve_options(unsigned level) {
  ImproveOptions options;
  switch (level) {
    case 1: options.min_dihedral = 15, options.move_vertices = false, options.passes = 1; break;
    case 2: break;
    case 3: options.min_dihedral = 30, options.passes = 6; break;
    default: throw OptionError("the level of improvement must be 1, 2 or 3");
  }
  return options;
}

ImproveReport improve(TetMesh& mesh, const Plc& plc, const ImproveOptions& options,
                      const Execution& execution) {
  return improvement::Improvement(mesh, plc, options, execution).run();
}

}  // namespace collarmesh
