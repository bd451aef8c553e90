#include "periodic/feature_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "collarmesh/error.h"
#include "common/distances.h"
#include "common/sort_uniquely.h"

namespace collarmesh::periodicity {

namespace {

constexpr double rounding_of_input = 1e-7;  // relative to the diagonal; CAD shapes are not more exact

/// The features of one group, sorted.
struct Features {
  std::vector<Index> vertices, curves;
};

Features features_of(const std::vector<Index>& patches, const Plc& plc) {
  Features of;
  for (const Index patch : patches) {
    const Plc::Patch& p = plc.patches[patch];
    of.vertices.insert(of.vertices.end(), p.vertices.begin(), p.vertices.end());
    of.curves.insert(of.curves.end(), p.curves.begin(), p.curves.end());
  }
  for (auto* features : {&of.vertices, &of.curves}) sort_uniquely(*features);
  return of;
}

/// The largest distance of a point from its intended place, and where it is.
struct Deviation {
  double distance = 0;
  Point where{};

  void see(double other, const Point& at) {
    if (other > distance) *this = {other, at};
  }
};

class Matcher {
 public:
  Matcher(const PatchPair& pair, const Plc& plc, double distance)
      : pair_(pair),
        plc_(plc),
        exact_(std::max(10 * plc.planar_tolerance, rounding_of_input * plc.bounds.diagonal())),
        distance_(std::max(distance, exact_)),
        first_(features_of(pair.first, plc)),
        second_(features_of(pair.second, plc)) {}

  FeatureImages run() {
    match_vertices();
    match_curves();
    match_patches();
    return std::move(images_);
  }

 private:
  [[noreturn]] void refuse(const std::string& feature, const Deviation& off) const {
    throw OptionError(fmt::format(
        "periodic '{}': {} has no image on the second patches: the nearest candidate is {:.3g} away from the "
        "image's place, ({:.6g}, {:.6g}, {:.6g}); periodic patches must be images of each other",
        pair_.text, feature, off.distance, off.where.x, off.where.y, off.where.z));
  }

  void match_vertices() {
    const auto place = [&](Index vertex) { return plc_.points[plc_.vertices[vertex].point]; };
    for (const Index vertex : first_.vertices) {
      const Point image = pair_.motion(place(vertex));
      Index nearest = none;
      double least = INFINITY;
      for (const Index other : second_.vertices)
        if (const double d = distance(place(other), image); d < least) nearest = other, least = d;
      if (!(least <= exact_))
        refuse(fmt::format("the vertex at ({:.6g}, {:.6g}, {:.6g})", place(vertex).x, place(vertex).y,
                           place(vertex).z),
               {least, image});
      images_.vertices.emplace_back(vertex, nearest);
    }
    require_same_number(first_.vertices.size(), second_.vertices.size(), "vertices");
  }

  void match_curves() {
    std::vector<std::vector<Point>> candidates;
    for (const Index curve : second_.curves) candidates.push_back(polyline(curve, {}));
    std::vector<bool> taken(candidates.size(), false);
    for (const Index curve : first_.curves) {
      const std::vector<Point> image = polyline(curve, pair_.motion);
      const double allowed = plc_.curves[curve].straight ? exact_ : distance_;
      Deviation best{INFINITY, image.front()};
      std::size_t nearest = candidates.size();
      for (std::size_t k = 0; k < candidates.size(); ++k) {
        if (taken[k]) continue;
        const Deviation off = deviation(image, candidates[k]);
        if (off.distance < best.distance) best = off, nearest = k;
      }
      if (!(best.distance <= allowed))
        refuse(
            fmt::format("the curve through ({:.6g}, {:.6g}, {:.6g})", at(curve).x, at(curve).y, at(curve).z),
            best);
      taken[nearest] = true;
      images_.curves.emplace_back(curve, second_.curves[nearest]);
    }
    require_same_number(first_.curves.size(), second_.curves.size(), "curves");
  }

  const Point& at(Index curve) const { return plc_.points[plc_.curves[curve].points.front()]; }

  /// Returns the polyline of a curve. A closed curve repeats its first point.
  std::vector<Point> polyline(Index curve, const Motion& motion) const {
    const Plc::Curve& of = plc_.curves[curve];
    std::vector<Point> points;
    for (const Index point : of.points) points.push_back(motion(plc_.points[point]));
    if (of.closed) points.push_back(points.front());
    return points;
  }

  /// Returns the largest distance of a point of either polyline from the other polyline. If their boxes
  /// differ by too much, returns the larger distance between corresponding corners of the boxes instead.
  Deviation deviation(const std::vector<Point>& a, const std::vector<Point>& b) const {
    Box box_of_a, box_of_b;
    for (const Point& p : a) box_of_a.add(p);
    for (const Point& p : b) box_of_b.add(p);
    Deviation off;
    for (const auto& [p, q] : {std::pair{box_of_a.min, box_of_b.min}, {box_of_a.max, box_of_b.max}})
      off.see(distance(p, q), p);
    if (off.distance > 2 * distance_) return off;
    off = {};
    for (const auto& [from, to] : {std::pair{&a, &b}, std::pair{&b, &a}})
      for (const Point& p : *from) {
        double least = INFINITY;
        for (std::size_t i = 1; i < to->size(); ++i)
          least = std::min(least, distance_to_segment(p, (*to)[i - 1], (*to)[i]));
        off.see(least, p);
      }
    return off;
  }

  /// Matches patches by their curves and vertices.
  void match_patches() {
    using Border = std::pair<std::vector<Index>, std::vector<Index>>;
    std::map<Index, Index> image_of_curve(images_.curves.begin(), images_.curves.end());
    std::map<Index, Index> image_of_vertex(images_.vertices.begin(), images_.vertices.end());
    const auto images_of = [](std::vector<Index> features, const std::map<Index, Index>& image) {
      for (Index& feature : features) feature = image.at(feature);
      std::sort(features.begin(), features.end());
      return features;
    };
    std::map<Border, Index> second;
    for (const Index patch : pair_.second)
      second[{plc_.patches[patch].curves, plc_.patches[patch].vertices}] = patch;
    for (const Index patch : pair_.first) {
      const Plc::Patch& of = plc_.patches[patch];
      const auto found =
          second.find({images_of(of.curves, image_of_curve), images_of(of.vertices, image_of_vertex)});
      if (found == second.end())
        throw OptionError(
            fmt::format("periodic '{}': patch {} has no image: none of the second patches is bordered by the "
                        "images of its curves; periodic patches must be images of each other",
                        pair_.text, of.tag));
      images_.patches.emplace_back(patch, found->second);
      second.erase(found);
    }
    require_same_number(pair_.first.size(), pair_.second.size(), "patches");
  }

  void require_same_number(std::size_t first, std::size_t second, const char* of) const {
    if (first != second)
      throw OptionError(
          fmt::format("periodic '{}': the first patches have {} {}, the second {}; periodic patches must be "
                      "images of each other",
                      pair_.text, first, of, second));
  }

  const PatchPair& pair_;
  const Plc& plc_;
  double exact_, distance_;  // allowed deviations
  Features first_, second_;
  FeatureImages images_;
};

}  // namespace

FeatureImages find_images(const PatchPair& pair, const Plc& plc, double distance) {
  return Matcher(pair, plc, distance).run();
}

std::vector<CurveClass> curve_classes(const std::vector<PatchPair>& pairs,
                                      const std::vector<FeatureImages>& images, std::size_t curves) {
  std::map<Index, std::vector<CurveImage>> images_of;  // by curve; with the inverse motion, an original also
                                                       // counts as an image of its image
  std::vector<bool> is_image(curves, false), seen(curves, false);
  for (std::size_t k = 0; k < pairs.size(); ++k)
    for (const auto& [curve, image] : images[k].curves) {
      if (curve == image) continue;  // the curve is an axis of rotation
      images_of[curve].push_back({image, pairs[k].motion});
      images_of[image].push_back({curve, inverse(pairs[k].motion)});
      is_image[image] = true;
    }
  std::vector<CurveClass> classes;
  for (const bool of_images : {false, true})  // if pairs form a cycle, all curves are images
    for (const auto& [original, direct] : images_of) {
      if (is_image[original] != of_images || seen[original]) continue;
      CurveClass& of = classes.emplace_back(CurveClass{original, {}});
      seen[original] = true;
      std::vector<CurveImage> open{{original, {}}};
      while (!open.empty()) {
        const CurveImage from = open.back();
        open.pop_back();
        for (const auto& [curve, motion] : images_of.at(from.curve)) {
          if (seen[curve]) continue;
          seen[curve] = true;
          of.images.push_back({curve, composed(from.motion, motion)});
          open.push_back(of.images.back());
        }
      }
    }
  return classes;
}

}  // namespace collarmesh::periodicity
