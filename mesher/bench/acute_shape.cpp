// Writes a member of the acute families of the tests as .poly files, one for each solid:
// PREFIX_1.poly, PREFIX_2.poly, ... With --copies N it is N turned copies in a cubic grid.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "support/acute_shapes.h"

namespace {

using collarmesh::Box;
using collarmesh::Index;
using collarmesh::Point;
using collarmesh::PolygonSoup;
using collarmesh::Vector;
namespace acute = collarmesh::testing::acute;

using Family = std::function<acute::Shape(std::span<const double>)>;

template <class... Parameters, std::size_t... Numbers>
Family family_of(acute::Shape (*make)(Parameters...), std::index_sequence<Numbers...>) {
  return [make](std::span<const double> values) {
    if (values.size() != sizeof...(Parameters))
      throw std::invalid_argument(fmt::format("it has {} parameters", sizeof...(Parameters)));
    return make(static_cast<Parameters>(values[Numbers])...);
  };
}

template <class... Parameters>
Family family(acute::Shape (*make)(Parameters...)) {
  return family_of(make, std::index_sequence_for<Parameters...>());
}

const std::map<std::string, Family>& families() {
  static const std::map<std::string, Family> all{
      {"comb", family(acute::comb)},
      {"cubes_touching_in_an_edge", family(acute::cubes_touching_in_an_edge)},
      {"cut_torus", family(acute::cut_torus)},
      {"facet_ending_inside", family(acute::facet_ending_inside)},
      {"facet_near_a_crease", family(acute::facet_near_a_crease)},
      {"fan", family(acute::fan)},
      {"knife", family(acute::knife)},
      {"lens", family(acute::lens)},
      {"pyramid", family(acute::pyramid)},
      {"pyramid_on_a_box", family(acute::pyramid_on_a_box)},
      {"pyramids_tip_to_tip", family(acute::pyramids_tip_to_tip)},
      {"round_cone", family(acute::round_cone)},
      {"sectors", family(acute::sectors)},
      {"segment_meeting_a_facet", family(acute::segment_meeting_a_facet)},
      {"segment_near_a_crease", family(acute::segment_near_a_crease)},
      {"segments_from_a_point", family(acute::segments_from_a_point)},
      {"spiked_octahedron", family(acute::spiked_octahedron)},
      {"star_prism", family(acute::star_prism)},
      {"two_knives", family(acute::two_knives)},
      {"wedge", family(acute::wedge)},
      {"wedge_on_a_large_one", family(acute::wedge_on_a_large_one)},
      {"wedges_touching_in_an_edge", family(acute::wedges_touching_in_an_edge)},
  };
  return all;
}

Box bounds(const std::vector<PolygonSoup>& soups) {
  Box box;
  for (const PolygonSoup& soup : soups)
    for (const Point& p : soup.points) box.add(p);
  return box;
}

void append(PolygonSoup& all, const PolygonSoup& one, const Vector& shift) {
  const auto first = static_cast<Index>(all.points.size());
  for (const Point& p : one.points) all.points.push_back(p + shift);
  for (Index f = 0; f < one.facet_count(); ++f) {
    all.begin_facet(one.facet_tag(f));
    for (Index q = one.facet_polygons(f)[0]; q < one.facet_polygons(f)[1]; ++q) {
      std::vector<Index> corners(one.polygon(q).begin(), one.polygon(q).end());
      for (Index& corner : corners) corner += first;
      all.add_polygon(corners);
    }
  }
  for (const auto& [a, b, tag] : one.segments) all.segments.push_back({first + a, first + b, tag});
  for (const auto& [point, tag, size] : one.region_points)
    all.region_points.push_back({point + shift, tag, size});
}

// The grid leaves half of the diagonal between neighbours, however they are turned.
std::vector<PolygonSoup> copies_of(const acute::Shape& shape, unsigned count) {
  const Box box = bounds(shape.soups);
  const double pitch = 1.5 * box.diagonal();
  const auto side = static_cast<unsigned>(std::ceil(std::cbrt(count) - 1e-9));
  std::vector<PolygonSoup> soups(shape.soups.size());
  for (unsigned i = 0; i < count; ++i) {
    const acute::Shape turned = acute::turned(shape, i + 1);
    const Point centre = bounds(turned.soups).centre();
    const unsigned row = i / side, layer = row / side;
    const Point cell = pitch * Point{static_cast<double>(i % side), static_cast<double>(row % side),
                                     static_cast<double>(layer)};
    for (std::size_t k = 0; k < soups.size(); ++k) append(soups[k], turned.soups[k], cell - centre);
  }
  return soups;
}

void write_facets(const PolygonSoup& soup, std::FILE* out) {
  fmt::print(out, "{} 1\n", soup.facet_count() + soup.segments.size());
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto [first, last] = soup.facet_polygons(f);
    fmt::print(out, "{} 0 {}\n", last - first, soup.facet_tag(f));
    for (Index q = first; q < last; ++q)
      fmt::print(out, "{} {}\n", soup.polygon(q).size(), fmt::join(soup.polygon(q), " "));
  }
  for (const auto& [a, b, tag] : soup.segments) fmt::print(out, "1 0 {}\n2 {} {}\n", tag, a, b);
}

void write_poly(const PolygonSoup& soup, const std::string& path) {
  std::FILE* out = std::fopen(path.c_str(), "w");
  if (out == nullptr) throw std::runtime_error("cannot write " + path);
  fmt::print(out, "{} 3 0 0\n", soup.points.size());
  for (std::size_t i = 0; i < soup.points.size(); ++i)
    fmt::print(out, "{} {} {} {}\n", i, soup.points[i].x, soup.points[i].y, soup.points[i].z);
  write_facets(soup, out);
  fmt::print(out, "0\n{}\n", soup.region_points.size());
  for (std::size_t i = 0; i < soup.region_points.size(); ++i) {
    const auto& [p, tag, size] = soup.region_points[i];
    fmt::print(out, "{} {} {} {} {} -1\n", i, p.x, p.y, p.z, tag);
  }
  std::fclose(out);
}

int write_shape(std::span<const std::string> arguments, unsigned copies) {
  const auto found = families().find(arguments[1]);
  if (found == families().end()) throw std::invalid_argument("no such family");
  std::vector<double> values;
  for (const std::string& text : arguments.subspan(2)) values.push_back(std::stod(text));
  const acute::Shape shape = found->second(values);
  const auto soups = copies == 0 ? shape.soups : copies_of(shape, copies);
  for (std::size_t k = 0; k < soups.size(); ++k)
    write_poly(soups[k], fmt::format("{}_{}.poly", arguments[0], k + 1));
  return 0;
}

int usage() {
  fmt::print(stderr, "usage: acute_shape PREFIX FAMILY PARAMETERS... [--copies N]\n");
  for (const auto& [name, make] : families()) fmt::print(stderr, "  {}\n", name);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    std::vector<std::string> arguments(argv + 1, argv + argc);
    unsigned copies = 0;
    if (arguments.size() > 2 && arguments[arguments.size() - 2] == "--copies") {
      copies = static_cast<unsigned>(std::stoul(arguments.back()));
      arguments.resize(arguments.size() - 2);
    }
    return arguments.size() < 2 ? usage() : write_shape(arguments, copies);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "acute_shape: %s\n", error.what());
    return 2;
  }
}
