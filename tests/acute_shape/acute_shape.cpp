// Writes a member of the families of the tests (acute shapes, polylines) as .poly files, one for each solid:
// PREFIX_1.poly, PREFIX_2.poly, ... --copies N writes N turned copies in a cubic grid; --small-copy SHARE
// (polylines only) adds a copy that is smaller by this factor. --triangulated also writes the member as one
// complex of conforming triangles: PREFIX.off if all triangles bound solids, else PREFIX.poly.
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

#include "conforming_triangles.h"
#include "support/acute_shapes.h"
#include "support/polylines.h"

namespace {

using collarmesh::Box;
using collarmesh::Index;
using collarmesh::Point;
using collarmesh::PolygonSoup;
using collarmesh::Vector;
using collarmesh::testing::TriangleComplex;
namespace acute = collarmesh::testing::acute;
namespace polylines = collarmesh::testing::polylines;

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

acute::Shape random_member(std::uint32_t seed, std::size_t number) {
  const std::vector<acute::Shape> members = acute::random_members(seed);
  if (number >= members.size())
    throw std::invalid_argument(fmt::format("random members are numbered from 0 to {}", members.size() - 1));
  return members[number];
}

const std::map<std::string, Family>& acute_families() {
  static const std::map<std::string, Family> all{
      {"comb", family(acute::comb)},
      {"cubes_touching_in_a_corner", family(acute::cubes_touching_in_a_corner)},
      {"cubes_touching_in_an_edge", family(acute::cubes_touching_in_an_edge)},
      {"curved_facet_ending_inside", family(acute::curved_facet_ending_inside)},
      {"cut_torus", family(acute::cut_torus)},
      {"drop_bar", family(acute::drop_bar)},
      {"drop_cone", family(acute::drop_cone)},
      {"drop_cone_in_a_room", family(acute::drop_cone_in_a_room)},
      {"facet_ending_inside", family(acute::facet_ending_inside)},
      {"facet_near_a_crease", family(acute::facet_near_a_crease)},
      {"fan", family(acute::fan)},
      {"knife", family(acute::knife)},
      {"lens", family(acute::lens)},
      {"long_lens", family(acute::long_lens)},
      {"pyramid", family(acute::pyramid)},
      {"pyramid_on_a_box", family(acute::pyramid_on_a_box)},
      {"pyramids_tip_to_tip", family(acute::pyramids_tip_to_tip)},
      {"random_member", family(random_member)},
      {"random_pyramid", family(acute::random_pyramid)},
      {"random_star_prism", family(acute::random_star_prism)},
      {"random_tetrahedron", family(acute::random_tetrahedron)},
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

const std::map<std::string, Family>& polyline_families() {
  static const std::map<std::string, Family> all{
      {"box_frames", family(polylines::box_frames)},
      {"crossed_strips", family(polylines::crossed_strips)},
      {"crossed_wires", family(polylines::crossed_wires)},
      {"graph", family(polylines::graph)},
      {"helices", family(polylines::helices)},
      {"outlines", family(polylines::outlines)},
      {"random_walk", family(polylines::random_walk)},
      {"shrinking_spiral", family(polylines::shrinking_spiral)},
      {"skew_combs", family(polylines::skew_combs)},
      {"skew_zigzags", family(polylines::skew_zigzags)},
      {"star", family(polylines::star)},
      {"torus_knot", family(polylines::torus_knot)},
      {"welded_mesh", family(polylines::welded_mesh)},
  };
  return all;
}

const Family& family_named(const std::string& name) {
  for (const auto* families : {&acute_families(), &polyline_families()})
    if (const auto found = families->find(name); found != families->end()) return found->second;
  throw std::invalid_argument("no such family");
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

// Returns copies in a grid that leaves half of the diagonal between neighbours, however they are turned.
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

void write_off(const TriangleComplex& complex, const std::string& path) {
  std::FILE* out = std::fopen(path.c_str(), "w");
  if (out == nullptr) throw std::runtime_error("cannot write " + path);
  fmt::print(out, "OFF\n{} {} 0\n", complex.points.size(), complex.triangles.size());
  for (const Point& p : complex.points) fmt::print(out, "{} {} {}\n", p.x, p.y, p.z);
  for (const auto& triangle : complex.triangles) fmt::print(out, "3 {}\n", fmt::join(triangle, " "));
  std::fclose(out);
}

void write_triangles(const TriangleComplex& complex, const std::string& prefix) {
  if (is_closed(complex)) return write_off(complex, prefix + ".off");
  PolygonSoup soup;
  soup.points = complex.points;
  for (const auto& triangle : complex.triangles) soup.add_facet(triangle);
  write_poly(soup, prefix + ".poly");
}

struct Request {
  std::vector<std::string> words;  // prefix, family and parameters
  unsigned copies = 0;
  double small_copy = 0;  // for polylines
  bool triangulated = false;
};

Request request_of(std::span<char* const> arguments) {
  Request request;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string argument = arguments[i];
    if (argument == "--triangulated")
      request.triangulated = true;
    else if (argument == "--copies" && i + 1 < arguments.size())
      request.copies = static_cast<unsigned>(std::stoul(arguments[++i]));
    else if (argument == "--small-copy" && i + 1 < arguments.size())
      request.small_copy = std::stod(arguments[++i]);
    else
      request.words.push_back(argument);
  }
  return request;
}

int write_shape(const Request& request) {
  const std::string &prefix = request.words[0], &family = request.words[1];
  std::vector<double> values;
  for (std::size_t i = 2; i < request.words.size(); ++i) values.push_back(std::stod(request.words[i]));
  acute::Shape shape = family_named(family)(values);
  if (request.small_copy > 0) shape = polylines::with_small_copy(shape, request.small_copy);
  const auto soups = request.copies == 0 ? shape.soups : copies_of(shape, request.copies);
  for (std::size_t k = 0; k < soups.size(); ++k)
    write_poly(soups[k], fmt::format("{}_{}.poly", prefix, k + 1));
  if (request.triangulated) write_triangles(collarmesh::testing::conforming_triangles(soups), prefix);
  return 0;
}

int list_families() {
  for (const auto& [name, make] : acute_families())
    if (name != "random_member") fmt::print("{}\n", name);
  return 0;
}

int list_random_members(const std::string& seed) {
  for (const acute::Shape& shape : acute::random_members(static_cast<std::uint32_t>(std::stoul(seed))))
    fmt::print("{}\n", shape.name);
  return 0;
}

int usage() {
  fmt::print(
      stderr,
      "usage: acute_shape PREFIX FAMILY PARAMETERS... [--copies N] [--small-copy SHARE] [--triangulated]\n"
      "       acute_shape --families\n"
      "       acute_shape --random-members SEED\n");
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Request request = request_of({argv + 1, static_cast<std::size_t>(argc - 1)});
    const std::vector<std::string>& words = request.words;
    if (words.size() == 1 && words[0] == "--families") return list_families();
    if (words.size() == 2 && words[0] == "--random-members") return list_random_members(words[1]);
    return words.size() < 2 ? usage() : write_shape(request);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "acute_shape: %s\n", error.what());
    return 2;
  }
}
