// Makes solids that touch or overlap share faces, so that no point is inside two of them.
#include "fuse.h"

#include <fmt/format.h>
#include <BOPAlgo_Builder.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Precision.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

namespace collarmesh::brep {

namespace {

using Group = std::vector<std::size_t>;  // indices of arguments

/// A solid or a face and the boxes around its faces.
struct Argument {
  explicit Argument(const TopoDS_Shape& the_shape) : shape(the_shape), faces(subshapes(shape, TopAbs_FACE)) {
    for (const TopoDS_Shape& face : faces) {
      BRepBndLib::Add(face, boxes.emplace_back(), /*useTriangulation=*/false);
      box.Add(boxes.back());
    }
  }

  /// Returns the indices of faces whose boxes meet a box.
  std::vector<std::size_t> faces_at(const Bnd_Box& other) const {
    std::vector<std::size_t> near;
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (!boxes[f].IsOut(other)) near.push_back(f);
    return near;
  }

  TopoDS_Shape shape;
  std::vector<TopoDS_Shape> faces;
  std::vector<Bnd_Box> boxes;
  Bnd_Box box;
};

/// Returns the indices of all pairs of a face of `a` and a face of `b` whose boxes meet.
std::vector<std::array<std::size_t, 2>> face_pairs(const Argument& a, const Argument& b) {
  std::vector<std::array<std::size_t, 2>> pairs;
  if (a.box.IsOut(b.box)) return pairs;
  const std::vector<std::size_t> others = b.faces_at(a.box);
  for (const std::size_t f : a.faces_at(b.box))
    for (const std::size_t g : others)
      if (!a.boxes[f].IsOut(b.boxes[g])) pairs.push_back({f, g});
  return pairs;
}

/// Returns groups of two or more arguments, each in ascending order. Arguments are in one group if they are
/// connected by pairs of faces whose boxes meet.
std::vector<Group> groups_of(const std::vector<Argument>& arguments) {
  std::vector<std::size_t> group(arguments.size());
  std::iota(group.begin(), group.end(), 0);
  const auto root = [&](std::size_t i) {
    while (group[i] != i) i = group[i] = group[group[i]];
    return i;
  };
  for (std::size_t i = 0; i < arguments.size(); ++i)
    for (std::size_t j = i + 1; j < arguments.size(); ++j)
      if (root(i) != root(j) && !face_pairs(arguments[i], arguments[j]).empty())
        group[std::max(root(i), root(j))] = std::min(root(i), root(j));
  std::map<std::size_t, Group> groups;
  for (std::size_t i = 0; i < arguments.size(); ++i) groups[root(i)].push_back(i);
  std::vector<Group> several;
  for (const auto& [first, members] : groups)
    if (members.size() > 1) several.push_back(members);
  return several;
}

bool share_a_vertex(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  TopTools_IndexedMapOfShape vertices;
  TopExp::MapShapes(a, TopAbs_VERTEX, vertices);
  const auto others = subshapes(b, TopAbs_VERTEX);
  return std::any_of(others.begin(), others.end(),
                     [&](const TopoDS_Shape& v) { return vertices.Contains(v); });
}

bool is_plane(const TopoDS_Shape& face) {
  return BRepAdaptor_Surface(TopoDS::Face(face), false).GetType() == GeomAbs_Plane;
}

/// Returns pairs of faces whose boxes meet, of solids that have no vertex in common. Such faces may touch in
/// a point inside both, which general fuse does not find. Leaves out pairs of planar faces: they touch in a
/// single point only at an edge or a vertex, which general fuse does find.
std::vector<std::array<TopoDS_Shape, 2>> pairs_apart(const std::vector<Argument>& solids) {
  std::map<std::array<std::size_t, 2>, Bnd_Box> tight;  // by solid and face
  const auto box = [&](std::size_t s, std::size_t f) -> const Bnd_Box& {
    const auto [found, fresh] = tight.try_emplace({s, f});
    if (fresh) BRepBndLib::AddOptimal(solids[s].faces[f], found->second, /*useTriangulation=*/false);
    return found->second;
  };
  std::vector<std::array<TopoDS_Shape, 2>> apart;
  for (std::size_t i = 0; i < solids.size(); ++i)
    for (std::size_t j = i + 1; j < solids.size(); ++j) {
      const auto pairs = face_pairs(solids[i], solids[j]);
      if (pairs.empty() || share_a_vertex(solids[i].shape, solids[j].shape)) continue;
      for (const auto& [f, g] : pairs)
        if (!(is_plane(solids[i].faces[f]) && is_plane(solids[j].faces[g])) && !box(i, f).IsOut(box(j, g)))
          apart.push_back({solids[i].faces[f], solids[j].faces[g]});
    }
  return apart;
}

/// Returns a vertex for each place where solids touch in a single point, which general fuse does not find.
/// Does not search if there are many pairs of faces, because each search takes long.
std::vector<TopoDS_Shape> contact_points(const TopoDS_Shape& fused) {
  constexpr std::size_t many = 100;
  std::vector<Argument> solids;
  for (const TopoDS_Shape& solid : subshapes(fused, TopAbs_SOLID)) solids.emplace_back(solid);
  const auto pairs = pairs_apart(solids);
  std::vector<TopoDS_Shape> vertices;
  if (pairs.size() > many) return vertices;
  for (const auto& [a, b] : pairs) {
    const BRepExtrema_DistShapeShape extrema(a, b);
    if (!extrema.IsDone() || extrema.Value() > Precision::Confusion()) continue;
    for (int k = 1; k <= extrema.NbSolution(); ++k)
      vertices.push_back(BRepBuilderAPI_MakeVertex(extrema.PointOnShape1(k)).Vertex());
  }
  return vertices;
}

}  // namespace

Fuse general_fuse(const std::vector<TopoDS_Shape>& shapes) {
  const auto fuse = std::make_shared<BOPAlgo_Builder>();
  fuse->SetNonDestructive(true);
  fuse->SetRunParallel(true);
  for (const TopoDS_Shape& shape : shapes) fuse->AddArgument(shape);
  fuse->Perform();
  return fuse->HasErrors() || fuse->Shape().IsNull() ? nullptr : fuse;
}

namespace {

double volume_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

}  // namespace

double unsoundness(BOPAlgo_Builder& fuse, const TopoDS_Shape& solid) {
  if (fuse.IsDeleted(solid)) return INFINITY;
  const TopTools_ListOfShape parts = fuse.Modified(solid);
  if (parts.IsEmpty()) return 0;  // the solid is unchanged
  double volume = 0;
  for (const TopoDS_Shape& part : parts) {
    if (!open_edges(part).empty()) return INFINITY;
    volume += volume_of(part);
  }
  const double before = volume_of(solid);
  return before != 0 ? std::fabs(volume / before - 1) : INFINITY;
}

namespace {

/// Fuses shapes, with a vertex at each place where solids touch in a point. Returns null if that fails.
Fuse fuse_with_contacts(const std::vector<TopoDS_Shape>& shapes) {
  try {
    const Fuse fuse = general_fuse(shapes);
    if (!fuse) return nullptr;
    const auto contacts = contact_points(fuse->Shape());
    if (contacts.empty()) return fuse;
    std::vector<TopoDS_Shape> with_contacts = shapes;
    with_contacts.insert(with_contacts.end(), contacts.begin(), contacts.end());
    return general_fuse(with_contacts);
  } catch (const Standard_Failure&) {
    return nullptr;
  }
}

/// Fuses the shapes that may touch. If parts of some solids are unsound, moves the solid with the largest
/// unsoundness from `shapes` to `left_out` and fuses again, because it may have spoilt the others. Returns
/// null if a fuse fails or fewer than two shapes are left.
Fuse sound_fuse(std::vector<TopoDS_Shape>& shapes, std::vector<TopoDS_Shape>& left_out) {
  constexpr int rounds = 3;  // from this round on all solids with unsound parts are left out
  for (int round = 1; shapes.size() > 1; ++round) {
    const Fuse fuse = fuse_with_contacts(shapes);
    if (!fuse) return nullptr;
    std::vector<double> off(shapes.size(), 0);
    for (std::size_t i = 0; i < shapes.size(); ++i)
      if (shapes[i].ShapeType() == TopAbs_SOLID) off[i] = unsoundness(*fuse, shapes[i]);
    const double worst = *std::max_element(off.begin(), off.end());
    if (worst <= rough_volume) return fuse;
    const double least = round < rounds ? worst : rough_volume;
    std::vector<TopoDS_Shape> kept;
    for (std::size_t i = 0; i < shapes.size(); ++i)
      (off[i] > rough_volume && off[i] >= least ? left_out : kept).push_back(shapes[i]);
    shapes = kept;
  }
  return nullptr;
}

/// The pieces into which the solids were cut, and the solids that contain each piece.
class Pieces {
 public:
  Pieces(const std::vector<Topology::Solid>& solids, const PartsOf& parts_of) {
    for (std::size_t s = 0; s < solids.size(); ++s)
      for (const TopoDS_Shape& part : parts_of(solids[s].shape)) {
        const auto piece = static_cast<std::size_t>(pieces_.Add(part) - 1);
        if (piece == holders_.size()) holders_.emplace_back();
        holders_[piece].push_back(s);
      }
    size_.assign(solids.size(), 0);
    common_.assign(solids.size(), false);
    for (const auto& holders : holders_)
      for (const std::size_t s : holders) {
        ++size_[s];
        common_[s] = common_[s] || holders.size() > 1;
      }
    for (const auto& holders : holders_)
      for (const std::size_t a : holders)
        for (const std::size_t b : holders) ++together_[{a, b}];
  }

  std::size_t count() const { return holders_.size(); }
  TopoDS_Shape shape(std::size_t piece) const { return pieces_(static_cast<int>(piece) + 1); }
  const std::vector<std::size_t>& holders(std::size_t piece) const { return holders_[piece]; }
  /// Returns whether a solid shares a piece with another solid.
  bool overlaps(std::size_t solid) const { return common_[solid]; }

  /// Returns the owner of a piece: the first of the solids that contain it, except solids that wholly contain
  /// another one of these. Otherwise that inner solid would lose all its pieces.
  std::size_t owner(std::size_t piece) const {
    for (const std::size_t s : holders_[piece])
      if (std::none_of(holders_[piece].begin(), holders_[piece].end(),
                       [&](std::size_t other) { return lies_inside(other, s); }))
        return s;
    return holders_[piece].front();
  }

 private:
  bool lies_inside(std::size_t inner, std::size_t outer) const {
    return size_[inner] < size_[outer] && together_.at({inner, outer}) == size_[inner];
  }

  TopTools_IndexedMapOfShape pieces_;
  std::vector<std::vector<std::size_t>> holders_;
  std::vector<std::size_t> size_;  // by solid: number of its pieces
  std::vector<bool> common_;
  std::map<std::array<std::size_t, 2>, std::size_t> together_;  // by pair of solids: number of pieces that
                                                                // both contain
};

}  // namespace

Topology::Solid merged(const std::vector<TopoDS_Shape>& pieces, int number) {
  Topology::Solid solid;
  solid.number = number;
  solid.shape = pieces.size() == 1 ? pieces.front() : compound_of(pieces);
  TopTools_IndexedMapOfShape once, walls;
  for (const TopoDS_Shape& piece : pieces)
    for (const TopoDS_Shape& face : boundary_of(piece))
      if (once.Contains(face))
        walls.Add(face);
      else
        once.Add(face);
  for (const TopoDS_Shape& piece : pieces)
    for (const TopoDS_Shape& face : boundary_of(piece))
      if (!walls.Contains(face)) solid.faces.push_back(face);
  return solid;
}

namespace {

std::string names_of(const std::vector<std::size_t>& holders, const std::vector<Topology::Solid>& solids) {
  std::vector<std::string> names;
  for (const std::size_t s : holders) names.push_back(fmt::format("Solid{}", solids[s].number));
  const std::string last = names.back();
  names.pop_back();
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

/// The common part of several solids, for a note.
struct Common {
  std::vector<std::size_t> holders;
  int number;  // number of the region that owns it
  double volume = 0, largest = 0;
  Point where;  // a place in its largest piece
};

void tell_overlaps(const std::string& file, const std::vector<Common>& overlaps, Topology& topology) {
  constexpr std::size_t listed = 10;
  for (std::size_t i = 0; i < std::min(listed, overlaps.size()); ++i)
    topology.notes.push_back(
        fmt::format("{}: {} overlap around {}; their common part, of volume {:.4g}, belongs to Solid{}", file,
                    names_of(overlaps[i].holders, topology.solids), text(overlaps[i].where),
                    overlaps[i].volume, overlaps[i].number));
  if (overlaps.size() > listed)
    topology.notes.push_back(fmt::format("{}: {} more overlaps of solids were treated in the same way", file,
                                         overlaps.size() - listed));
}

/// Assigns each piece to a region. Returns the regions in the order of their numbers.
std::vector<Topology::Solid> distribute(const std::string& file, Overlap overlap, const Pieces& pieces,
                                        Topology& topology) {
  int next = 1;
  for (const Topology::Solid& solid : topology.solids) next = std::max(next, solid.number + 1);
  std::map<int, std::vector<TopoDS_Shape>> regions;
  std::map<std::pair<std::vector<std::size_t>, std::size_t>, Common> overlaps;
  for (std::size_t p = 0; p < pieces.count(); ++p) {
    const std::size_t owner = pieces.owner(p);
    int number = topology.solids[owner].number;
    if (pieces.holders(p).size() > 1) {
      Common& common = overlaps[{pieces.holders(p), overlap == Overlap::region ? 0 : owner}];
      if (common.holders.empty())
        common = {pieces.holders(p), overlap == Overlap::region ? next++ : number, 0, 0, {}};
      number = common.number;
      const double volume = volume_of(pieces.shape(p));
      common.volume += volume;
      if (volume > common.largest) {
        common.largest = volume;
        common.where = place_of(pieces.shape(p));
      }
    }
    regions[number].push_back(pieces.shape(p));
  }
  std::vector<Common> list;
  list.reserve(overlaps.size());
  for (const auto& [key, common] : overlaps) list.push_back(common);
  tell_overlaps(file, list, topology);
  for (const Topology::Solid& solid : topology.solids)
    if (regions.count(solid.number) == 0)
      topology.notes.push_back(fmt::format("{}: nothing is left of Solid{}", file, solid.number));
  TopTools_MapOfShape overlapping;
  for (std::size_t p = 0; p < pieces.count(); ++p)
    for (const std::size_t s : pieces.holders(p))
      if (pieces.overlaps(s)) overlapping.Add(pieces.shape(p));
  std::vector<Topology::Solid> result;
  for (const auto& [number, parts] : regions)
    if (std::any_of(parts.begin(), parts.end(),
                    [&](const TopoDS_Shape& part) { return overlapping.Contains(part); }))
      result.push_back(merged(parts, number));
    else
      for (const TopoDS_Shape& part : parts) result.push_back(merged({part}, number));
  return result;
}

/// The fuses of a topology's closed solids and internal faces.
class SharedFaces {
 public:
  SharedFaces(const std::string& file, Topology& topology) : file_(file), topology_(topology) {
    for (const TopoDS_Shape& face : topology.internal_faces) shapes_.push_back(face);
    for (const Topology::Solid& solid : topology.solids)
      if (!solid.open) shapes_.push_back(solid.shape);
  }

  void run(Overlap overlap) {
    if (shapes_.size() < 2) return;
    std::vector<Argument> arguments(shapes_.begin(), shapes_.end());
    tell_nested(arguments);
    for (const Group& group : groups_of(arguments)) fuse(group);
    if (fuses_.empty()) return;
    replace(overlap);
  }

 private:
  TopTools_ListOfShape parts_of(const TopoDS_Shape& old) const {
    for (const Fuse& fuse : fuses_) {
      if (fuse->IsDeleted(old)) return {};
      const TopTools_ListOfShape parts = fuse->Modified(old);
      if (!parts.IsEmpty()) return parts;
    }
    TopTools_ListOfShape itself;
    itself.Append(old);
    return itself;
  }

  void fuse(const Group& group) {
    std::vector<TopoDS_Shape> members, left_out;
    for (const std::size_t i : group) members.push_back(shapes_[i]);
    if (const Fuse fuse = sound_fuse(members, left_out)) {
      fuses_.push_back(fuse);
      for (const TopoDS_Shape& member : members) fused_.Add(member);
    } else {
      left_out.insert(left_out.end(), members.begin(), members.end());
    }
    if (left_out.empty()) return;
    topology_.fused = false;
    std::vector<std::string> names;
    names.reserve(left_out.size());
    for (const TopoDS_Shape& shape : left_out) names.push_back(topology_.name(shape));
    constexpr std::size_t listed = 5;
    const bool more = names.size() > listed;
    names.resize(std::min(listed, names.size()));
    topology_.notes.push_back(fmt::format(
        "{}: OpenCASCADE's general fuse does not find where {}{} and the solids around {} meet, so repair "
        "has to cut the triangles of these solids",
        file_, fmt::join(names, ", "), more ? ", ..." : "", text(place_of(left_out.front()))));
  }

  /// Adds a note on each solid that lies inside another one and does not touch its faces: it becomes a region
  /// of its own.
  void tell_nested(const std::vector<Argument>& arguments) {
    for (const Argument& inner : arguments)
      for (const Argument& outer : arguments)
        if (inner.shape.ShapeType() == TopAbs_SOLID && outer.shape.ShapeType() == TopAbs_SOLID &&
            lies_inside(inner, outer))
          topology_.notes.push_back(fmt::format("{}: {} lies inside {} and is a region of its own there",
                                                file_, topology_.name(inner.shape),
                                                topology_.name(outer.shape)));
  }
  static bool lies_inside(const Argument& inner, const Argument& outer) {
    if (&inner == &outer || inner.box.IsVoid() || outer.box.IsVoid()) return false;
    if (outer.box.IsOut(inner.box.CornerMin()) || outer.box.IsOut(inner.box.CornerMax())) return false;
    const TopExp_Explorer vertex(inner.shape, TopAbs_VERTEX);
    if (!vertex.More() || !face_pairs(inner, outer).empty()) return false;
    const BRepClass3d_SolidClassifier place(outer.shape, BRep_Tool::Pnt(TopoDS::Vertex(vertex.Current())),
                                            Precision::Confusion());
    return place.State() == TopAbs_IN;
  }

  void replace(Overlap overlap) {
    const TopoDS_Shape before = everything_before();
    std::vector<Topology::Solid> open, solids;
    for (const Topology::Solid& solid : topology_.solids) (solid.open ? open : solids).push_back(solid);
    topology_.solids = solids;
    const auto parts = [this](const TopoDS_Shape& old) { return parts_of(old); };
    solids = distribute(file_, overlap, Pieces(topology_.solids, parts), topology_);
    solids.insert(solids.end(), open.begin(), open.end());
    topology_.solids = solids;
    replace_internal_faces();
    const TopoDS_Shape after = everything_after();
    carry_numbers(before, after, parts, topology_);
    topology_.all = after;
  }

  TopoDS_Shape everything_before() const {
    std::vector<TopoDS_Shape> all = shapes_;
    for (const Topology::Solid& solid : topology_.solids)
      if (solid.open) all.push_back(solid.shape);
    return compound_of(all);
  }

  void replace_internal_faces() {
    TopTools_MapOfShape bounding;
    for (const Topology::Solid& solid : topology_.solids)
      for (const TopoDS_Shape& face : solid.faces) bounding.Add(face);
    std::vector<TopoDS_Shape> internal;
    for (const TopoDS_Shape& face : topology_.internal_faces)
      for (const TopoDS_Shape& part : parts_of(face))
        if (bounding.Add(part)) internal.push_back(part);
    topology_.internal_faces = internal;
  }

  /// Returns the shape after the fuses, without walls between parts of one region.
  TopoDS_Shape everything_after() const {
    if (fuses_.size() == 1 && fused_.Extent() == static_cast<int>(shapes_.size()) &&
        !has_walls(fuses_.front()->Shape()))
      return fuses_.front()->Shape();
    std::vector<TopoDS_Shape> all;
    TopTools_MapOfShape added;
    for (const Topology::Solid& solid : topology_.solids)
      for (const TopoDS_Shape& face : solid.faces)
        if (added.Add(face)) all.push_back(face);
    all.insert(all.end(), topology_.internal_faces.begin(), topology_.internal_faces.end());
    return compound_of(all);
  }
  bool has_walls(const TopoDS_Shape& fused) const {
    TopTools_MapOfShape kept;
    for (const Topology::Solid& solid : topology_.solids)
      for (const TopoDS_Shape& face : solid.faces) kept.Add(face);
    for (const TopoDS_Shape& face : topology_.internal_faces) kept.Add(face);
    const auto faces = subshapes(fused, TopAbs_FACE);
    return std::any_of(faces.begin(), faces.end(),
                       [&](const TopoDS_Shape& face) { return !kept.Contains(face); });
  }

  const std::string& file_;
  Topology& topology_;
  std::vector<TopoDS_Shape> shapes_;  // internal faces, then closed solids
  std::vector<Fuse> fuses_;
  TopTools_MapOfShape fused_;
};

}  // namespace

void share_faces(const std::string& file, const CadOptions& options, Topology& topology) {
  SharedFaces(file, topology).run(options.overlap);
}

}  // namespace collarmesh::brep
