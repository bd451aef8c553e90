#include "io/abaqus_periodic.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "io/file_writer.h"

namespace collarmesh::io {

namespace {

using Matrix = std::array<Vector, 3>;  // by rows

constexpr Matrix identity{Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}};

Matrix transposed(const Matrix& m) {
  return {Vector{m[0].x, m[1].x, m[2].x}, Vector{m[0].y, m[1].y, m[2].y}, Vector{m[0].z, m[1].z, m[2].z}};
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = a[i].x * b[0] + a[i].y * b[1] + a[i].z * b[2];
  return result;
}

/// The displacement of a node as a weighted sum of displacements: those of the first node of its chain of
/// images (`root`) and of the reference nodes. The weights are matrices.
struct Shares {
  Matrix root = identity;
  std::map<std::size_t, Matrix> references;  ///< by pair

  /// Returns the shares of this node's image or, if `backwards`, those of the node whose image this node is.
  /// `rows`: the rotation matrix of the pair's motion, by rows.
  Shares moved(const Matrix& rows, std::size_t pair, bool backwards) const {
    const Matrix by = backwards ? transposed(rows) : rows;
    Shares result{product(by, root), {}};
    for (const auto& [k, share] : references) result.references.emplace(k, product(by, share));
    Matrix& own = result.references.try_emplace(pair).first->second;
    for (std::size_t i = 0; i < 3; ++i) own[i] = backwards ? own[i] - by[i] : own[i] + identity[i];
    return result;
  }
};

class Equations {
 public:
  Equations(FileWriter& out, const TetMesh& mesh) : out_(out), mesh_(mesh) {
    for (std::size_t k = 0; k < mesh.periodic.size(); ++k)
      for (const auto& [node, image] : mesh.periodic[k].nodes) {
        if (node == image) continue;
        steps_[node].push_back({image, k, false});
        steps_[image].push_back({node, k, true});
        images_.insert(image);
      }
  }

  void write() {
    std::vector<Index> starts;  // where chains may begin: nodes that are no images, then the other nodes,
                                // because a closed chain consists of images
    for (const bool are_images : {false, true})
      for (const auto& each : steps_)
        if (images_.contains(each.first) == are_images) starts.push_back(each.first);
    if (!starts.empty()) out_ << "*NSET, NSET=PERIODIC_HELD\n" << std::size_t{starts.front()} + 1 << ",\n";
    out_ << "*EQUATION\n";
    for (const Index start : starts) write_chains_from(start);
  }

 private:
  struct Step {
    Index to;
    std::size_t pair;
    bool backwards;
  };

  void write_chains_from(Index root) {
    if (!met_.insert(root).second) return;
    std::deque<std::pair<Index, Shares>> next{{root, {}}};
    for (; !next.empty(); next.pop_front()) {
      const auto [node, shares] = next.front();
      if (node != root)
        for (std::size_t i = 0; i < 3; ++i) write_equation(node, i, root, shares);
      for (const Step& step : steps_.at(node))
        if (met_.insert(step.to).second)
          next.emplace_back(step.to,
                            shares.moved(mesh_.periodic[step.pair].motion.rows, step.pair, step.backwards));
    }
  }

  void write_equation(Index node, std::size_t i, Index root, const Shares& shares) {
    terms_ = {{std::size_t{node} + 1, i + 1, 1}};
    add_terms(std::size_t{root} + 1, shares.root[i]);
    for (const auto& [pair, share] : shares.references) add_terms(mesh_.points.size() + pair + 1, share[i]);
    out_ << terms_.size() << '\n';
    constexpr std::size_t terms_a_line = 4;
    for (std::size_t k = 0; k < terms_.size(); ++k)
      out_ << terms_[k].node << ", " << terms_[k].direction << ", "
           << fmt::format("{:.12g}", terms_[k].factor)
           << (k + 1 == terms_.size() || (k + 1) % terms_a_line == 0 ? "\n" : ", ");
  }

  void add_terms(std::size_t node, const Vector& share) {
    constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();  // rounding error of sines and
                                                                             // cosines
    for (std::size_t j = 0; j < 3; ++j)
      if (std::fabs(share[j]) > rounding) terms_.push_back({node, j + 1, -share[j]});
  }

  struct Term {
    std::size_t node, direction;  // counted from 1
    double factor;
  };

  FileWriter& out_;
  const TetMesh& mesh_;
  std::map<Index, std::vector<Step>> steps_;
  std::set<Index> images_, met_;
  std::vector<Term> terms_;
};

void write_reference(FileWriter& out, const TetMesh& mesh, std::size_t pair) {
  Box box;
  for (const auto& each : mesh.periodic[pair].nodes) box.add(mesh.points[each[1]]);
  const Point at = box.empty() ? Point{} : box.centre();
  out << "*NODE, NSET=PERIODIC_" << pair + 1 << "_REFERENCE\n"
      << mesh.points.size() + pair + 1 << fmt::format(", {:.12g}, {:.12g}, {:.12g}\n", at.x, at.y, at.z);
}

void write_axis(FileWriter& out, const TetMesh& mesh, std::size_t pair) {
  bool any = false;
  for (const auto& [node, image] : mesh.periodic[pair].nodes) {
    if (node != image) continue;
    if (!any) out << "*NSET, NSET=PERIODIC_" << pair + 1 << "_AXIS\n";
    any = true;
    out << std::size_t{node} + 1 << ",\n";
  }
}

}  // namespace

std::string abaqus_periodic_path(const std::string& path) {
  const std::filesystem::path mesh(path);
  return (mesh.parent_path() / (mesh.stem().string() + "_periodic" + mesh.extension().string())).string();
}

void write_abaqus_periodic(const std::string& path, const TetMesh& mesh) {
  FileWriter out(path);
  out << "** Periodic conditions, written by collarmesh; to be included behind the mesh, before all steps.\n";
  for (std::size_t k = 0; k < mesh.periodic.size(); ++k) {
    write_reference(out, mesh, k);
    write_axis(out, mesh, k);
  }
  Equations(out, mesh).write();
  out.commit();
}

}  // namespace collarmesh::io
