#include <fmt/format.h>

#include <algorithm>
#include <type_traits>
#include <utility>

#include "collarmesh/options.h"
#include "common/shared_bounds.h"

namespace collarmesh {

namespace {

using Kind = Option::Kind;
using Unit = Option::Unit;

template <class T>
constexpr Kind kind_of(bool has_words) {
  if (std::is_same_v<T, bool> || std::is_enum_v<T>) return has_words ? Kind::choice : Kind::flag;
  if (std::is_integral_v<T>) return Kind::count;
  if (std::is_floating_point_v<T>) return Kind::number;
  if (std::is_same_v<T, std::string>) return Kind::text;
  return std::is_same_v<T, std::vector<std::string>> ? Kind::texts : Kind::sizes;
}

/// Access to a member of RunOptions, or of a struct in it. `has_words`: the member is a bool or an
/// enumeration, and the option has a word for each of its values.
template <bool has_words, auto... members>
struct At {
  static auto& of(auto& options) { return (options.*....*members); }
  using Type = std::remove_cvref_t<decltype(of(std::declval<RunOptions&>()))>;

  static OptionValue get(const Option& option, const RunOptions& options) {
    const Type& value = of(options);
    if constexpr (std::is_enum_v<Type> && has_words)
      return option.words[static_cast<std::size_t>(value)];
    else if constexpr (std::is_enum_v<Type>)
      return value != Type{};
    else if constexpr (kind_of<Type>(false) == Kind::count)
      return std::uint64_t{value};
    else
      return value;
  }
  static void set(const Option& option, RunOptions& options, const OptionValue& given) {
    Type& value = of(options);
    if constexpr (std::is_enum_v<Type> && has_words) {
      const auto word = std::ranges::find(option.words, std::get<std::string>(given));
      value = static_cast<Type>(word - option.words.begin());
    } else if constexpr (std::is_enum_v<Type>) {
      value = static_cast<Type>(std::get<bool>(given));
    } else if constexpr (kind_of<Type>(false) == Kind::count) {
      value = static_cast<Type>(std::get<std::uint64_t>(given));
    } else {
      value = std::get<Type>(given);
    }
  }
  static constexpr Option::Place place{kind_of<Type>(has_words), &get, &set};
};

template <auto... members>
constexpr Option::Place at = At<false, members...>::place;
template <auto... members>
constexpr Option::Place choice_at = At<true, members...>::place;
template <auto member>
constexpr Option::Place in_mesh = at<&RunOptions::mesh, member>;
template <auto member>
constexpr Option::Place in_bounds = at<&RunOptions::mesh, &MeshOptions::bounds, member>;

/// The bound on the radius-edge ratio. Setting it also restricts thin tets to creases and narrow places;
/// without this option they may be anywhere.
constexpr Option::Place asked_ratio{Kind::number, in_bounds<&Bounds::radius_edge>.get,
                                    [](const Option&, RunOptions& options, const OptionValue& value) {
                                      options.mesh.bounds.radius_edge = std::get<double>(value);
                                      options.mesh.bounds.thin_in_narrow_places_only = true;
                                    }};

/// The dimension of the elements. If it is below 3, the facets need not bound a solid.
constexpr Option::Place asked_dimension{Kind::count, at<&RunOptions::dimension>.get,
                                        [](const Option&, RunOptions& options, const OptionValue& value) {
                                          options.dimension =
                                              static_cast<unsigned>(std::get<std::uint64_t>(value));
                                          if (options.dimension < 3) options.complex.require_solid = false;
                                        }};

constexpr unsigned writing = Option::mesh | Option::convert | Option::remesh,
                   refining = Option::mesh | Option::convert | Option::programs,
                   meshing = writing | Option::programs, judging = meshing | Option::check,
                   sizing = meshing | Option::info,
                   complexes = refining | Option::check | Option::info | Option::repair,
                   everywhere = judging | sizing | Option::repair;

const char* const size_group = "Size (target edge lengths, absolute, input units)";
const char* const quality_group = "Quality";
const char* const partitions_group = "Partitions (for programs that run on many ranks)";
const char* const complex_group = "The complex";
const char* const budget_group = "Budgets (hitting one is exit code 5)";

std::vector<Option> size_options() {
  return {
      {.name = "size LENGTH",
       .place = in_mesh<&MeshOptions::size>,
       .unit = Unit::length,
       .default_text = "1/20 of the diagonal",
       .help = "Target edge length everywhere; 0: the default",
       .commands = sizing & ~unsigned{Option::remesh}},
      {.name = "size LENGTH",
       .place = in_mesh<&MeshOptions::size>,
       .unit = Unit::length,
       .default_text = "the size field's, else the mesh's own edge lengths",
       .help = "Target edge length everywhere; 0: the default",
       .commands = Option::remesh},
      {.name = "size-min LENGTH",
       .place = in_mesh<&MeshOptions::size_min>,
       .unit = Unit::length,
       .default_text = "none",
       .help = "Smallest target edge length; smaller local sizes are raised to it"},
      {.name = "region-size TAG=LENGTH",
       .place = in_mesh<&MeshOptions::region_size>,
       .unit = Unit::length,
       .finer = true,
       .help = "Target edge length in the regions with this tag"},
      {.name = "patch-size TAG=LENGTH",
       .place = in_mesh<&MeshOptions::patch_size>,
       .unit = Unit::length,
       .finer = true,
       .help = "Target edge length on the patches (faces) with this tag"},
      {.name = "curve-size TAG=LENGTH",
       .place = in_mesh<&MeshOptions::curve_size>,
       .unit = Unit::length,
       .finer = true,
       .help = "Target edge length on the curves (edges) with this tag"},
      {.name = "size-field FILE",
       .place = at<&RunOptions::size_field_file>,
       .finer = true,
       .help =
           "Sizes by place: .json (balls, boxes, cylinders, distances from features), or .vtu or .msh with a "
           "scalar on its points",
       .details = "never above `--size`; see [Sizes](sizes.md#by-place)"},
      {.name = "elements-per-circle N",
       .place = in_mesh<&MeshOptions::elements_per_circle>,
       .finer = true,
       .default_text = "none",
       .help = "Refine where smooth surfaces and edges curve: N elements per full circle"},
      {.name = "elements-across-gap N",
       .place = in_mesh<&MeshOptions::elements_across_gap>,
       .finer = true,
       .default_text = "none",
       .help = "Refine where surfaces face each other across a thin part: N elements between them"},
      {.name = "gradation G",
       .place = in_mesh<&MeshOptions::gradation>,
       .default_text = "unlimited",
       .help = "Growth of size per unit length away from finer features",
       .details = "a target, not certified"}};
}

std::vector<Option> quality_options() {
  return {
      {.name = "profile",
       .words = {"standard", "paper"},
       .place = choice_at<&RunOptions::mesh, &MeshOptions::profile>,
       .help = "paper: exactly what the paper's proofs assume, for comparisons",
       .details =
           "sets `--crease-angle 90`, `--radius-edge 2.83` everywhere (or a larger one), `--coarsen off`, "
           "`--improve 0`, `--thin-angle 0` and no size",
       .commands = refining | Option::check},
      {.name = "start",
       .words = {"auto", "refinement", "constrained"},
       .place = choice_at<&RunOptions::start>,
       .help =
           "Mesh that the run begins with; constrained: tetrahedra that keep the input's facets as they are",
       .details =
           "`auto`: refinement, or `constrained` if refinement takes far more vertices than the sizes ask "
           "for; see [Parts that explode](architecture/constrained.md)",
       .commands = refining},
      {.name = "radius-edge RHO",
       .place = asked_ratio,
       .unit = Unit::ratio,
       .low = 1,
       .help = "Bound on circumradius / shortest edge of a tetrahedron that is not thin",
       .details = "if it is given, tetrahedra may be thin only at creases and in narrow places, where parts "
                  "of the shape that do not touch, or meet in a crease, are nearer than the longest edge / "
                  "RHO; without it they may be thin anywhere; below sqrt 2 refinement may not terminate",
       .commands = judging},
      {.name = "vertex-ratio TAU",
       .place = in_mesh<&MeshOptions::vertex_ratio>,
       .unit = Unit::ratio,
       .low = 2.83,
       .finer = true,
       .zero = true,
       .default_text = "none",
       .help = "Refine until, at each vertex, the largest circumradius / the shortest edge is below this "
               "bound, which must exceed 2 sqrt 2",
       .details = "not certified: coarsening and improvement may exceed it, so a warning asks for "
                  "`--coarsen off`",
       .commands = refining},
      {.name = "collar-angle DEGREES",
       .place = in_bounds<&Bounds::collar_angle>,
       .unit = Unit::degrees,
       .low = 100,
       .high = 175,
       .help = "Bound on dihedral angles in collars, the tetrahedra that touch a crease",
       .details = "bounds of 130 and more were kept on all shapes tried, those of 110 and more on most if "
                  "the mesh is coarsened",
       .commands = refining | Option::check},
      {.name = "collar-creation",
       .words = {"in-pass", "up-front"},
       .place = choice_at<&RunOptions::mesh, &MeshOptions::collar_creation>,
       .help = "in-pass: the balls around creases are placed during the refinement, as in the paper; "
               "up-front: all of them before it",
       .details = "the guarantees are the same",
       .commands = refining},
      {.name = "theta THETA",
       .place = in_mesh<&MeshOptions::theta>,
       .high = 0.449,
       .help = "If a point of the input is nearer to the centre of a gap ball than this share of the ball's "
               "radius, insert that point in place of the centre; 0: never",
       .details = "see [Theory](theory.md)",
       .commands = refining},
      {.name = "distance LENGTH",
       .place = in_bounds<&Bounds::distance>,
       .unit = Unit::length,
       .finer = true,
       .default_text = "1/10 of the size, less where the part is thin",
       .help = "Largest distance from smooth surfaces and curves",
       .details = "curves that turn by half a circle or more get at least seven edges to a circle",
       .commands = sizing},
      {.name = "distance LENGTH",
       .place = in_bounds<&Bounds::distance>,
       .unit = Unit::length,
       .default_text = "1/200 of the diagonal, less where the part is thin",
       .help = "Largest distance from smooth surfaces and curves",
       .commands = Option::check | Option::programs},
      {.name = "smooth-surface",
       .place = at<&RunOptions::smooth_surface>,
       .help =
           "Move the nodes on curved faces and curves onto a smooth surface through the given mesh's nodes",
       .details = "not farther from the triangles of the mesh than `--distance`; see [Adaptive "
                  "meshing](adaptive.md#a-smooth-surface)",
       .commands = Option::remesh | Option::programs},
      {.name = "seed N",
       .place = in_mesh<&MeshOptions::seed>,
       .help = "Seed of the pseudo-random offsets",
       .details = "same input, options and seed: same mesh",
       .commands = refining},
      {.name = "coarsen",
       .words = {"on", "off"},
       .place = choice_at<&RunOptions::coarsen>,
       .help = "on: as few tetrahedra as the sizes ask for, thin ones in thin places; off: the bound on "
               "circumradius / shortest edge holds everywhere outside collars",
       .commands = refining},
      {.name = "thin-angle DEGREES",
       .place = in_bounds<&Bounds::thin_angle>,
       .unit = Unit::degrees,
       .low = 0.1,
       .high = largest_thin_angle,
       .zero = true,
       .help = "Smallest dihedral angle of thin tetrahedra; at creases below twice this angle, half of the "
               "crease's angle; 0: no tetrahedron may be thin",
       .details = "values below 5 save tetrahedra in sharp wedges only",
       .commands = judging},
      {.name = "improve LEVEL",
       .place = at<&RunOptions::improve>,
       .high = highest_improve_level,
       .help = "Removal of slivers: 0 none; 1 quick: angles below 15 degrees, vertices stay; 2 good: below "
               "20; 3 best: below 30"},
      {.name = "min-dihedral DEGREES",
       .place = at<&RunOptions::min_dihedral>,
       .unit = Unit::degrees,
       .high = 60,
       .default_text = "15, 20, 30 by level",
       .help = "Improve tetrahedra with smaller dihedral angles",
       .details = "for CAD files the goal is 2% higher, because vertices move onto the shape afterwards; few "
                  "tetrahedra reach more than 30, and trying takes many times as long as the rest"}};
}

std::vector<Option> element_options() {
  return {
      {.name = "order ORDER",
       .place = at<&RunOptions::order>,
       .low = 1,
       .high = 2,
       .help = "Order of the elements: 1 straight, with nodes at the corners; 2 with a mid-edge node on "
               "every edge, curved on smooth surfaces",
       .commands = sizing},
      {.name = "dimension D",
       .place = asked_dimension,
       .low = 1,
       .high = 3,
       .help =
           "Dimension of the elements: 3 tetrahedra in the solids; 2 triangles on the surfaces, which need "
           "not be closed; 1 lines on the curves, for beams",
       .details = "see [Shells](shells.md)",
       .commands = Option::mesh | Option::programs},
      {.name = "faces NAME",
       .place = at<&RunOptions::faces>,
       .help = "Mesh only this patch (name or number) with triangles; for --dimension 2, and for checking "
               "such a mesh",
       .details = "see [Shells](shells.md#some-faces-of-a-solid)",
       .commands = Option::mesh | Option::programs | Option::check},
      {.name = "triangle-elements",
       .words = {"shell", "plane-stress", "plane-strain"},
       .place = choice_at<&RunOptions::triangle_elements>,
       .help = "Elements of --dimension 2 in .inp: S3 and S6, CPS3 and CPS6, or CPE3 and CPE6; the CP types "
               "need a mesh in the plane z = 0",
       .commands = Option::mesh},
      {.name = "interior-node",
       .place = in_bounds<&Bounds::interior_node>,
       .help = "Insert nodes so that no tetrahedron has all corners on boundaries, interfaces or internal "
               "patches",
       .details = "see [Interior nodes](embedded.md#a-node-inside-of-each-tetrahedron)",
       .commands = refining | Option::check}};
}

std::vector<Option> split_options() {
  return {
      {.name = "split NAME",
       .place = at<&RunOptions::split, &SplitOptions::patches>,
       .help = "Give both sides of this internal patch (name or number) nodes of their own, for a crack or a "
               "contact",
       .details = "see [Cracks](embedded.md#open-the-crack)"},
      {.name = "keep-apart",
       .place = at<&RunOptions::split, &SplitOptions::keep_apart>,
       .help = "Split all patches between two regions, as --split does with one patch"},
      {.name = "interaction",
       .words = {"free", "tie", "contact"},
       .place = choice_at<&RunOptions::split, &SplitOptions::interaction>,
       .help = "In .inp files, join the sides of split patches by ties or contact pairs",
       .details =
           "for contact, define `*SURFACE INTERACTION, NAME=CONTACT` in the job before the mesh is included",
       .commands = Option::mesh},
      {.name = "cohesive",
       .place = at<&RunOptions::split, &SplitOptions::cohesive>,
       .help = "Put cohesive elements of no thickness between the sides of split patches, in .inp",
       .commands = Option::mesh}};
}

std::vector<Option> layer_options() {
  return {
      {.name = "layers FACES",
       .place = at<&RunOptions::layers, &LayerOptions::walls>,
       .help =
           "Put layers of prisms on these faces: names or numbers with commas between them, or all; "
           "heights follow after a colon: FACES:first=0.1,growth=1.2,count=3 or FACES:thickness=0.5,count=3",
       .details = "the first height is a tenth of the edges there unless given; see "
                  "[Boundary layers](layers.md)"},
      {.name = "layers-tets",
       .place = at<&RunOptions::layers, &LayerOptions::tets>,
       .help = "Divide the prisms and pyramids of layers into tetrahedra"}};
}

std::vector<Option> periodic_options() {
  return {{.name = "periodic PAIR",
           .place = at<&RunOptions::periodic, &PeriodicOptions::pairs>,
           .help = "Mesh two groups of planar patches alike: x, y or z for those at both ends of the shape "
                   "along this axis; or A=B with names or numbers, and a motion if needed: A=B:translation, "
                   "A=B:rotation,z,90",
           .details = "see [Periodic cells](periodic.md#pairs)"}};
}

std::vector<Option> partition_options() {
  return {
      {.name = "partitions N",
       .place = at<&RunOptions::partitions>,
       .low = 1,
       .high = 1e6,
       .default_text = "not divided",
       .help = "Divide the tetrahedra among N ranks, evenly and with few shared faces",
       .details = "see [Formats](formats.md#partitions)"},
      {.name = "ghost-cells",
       .place = at<&RunOptions::ghost_cells>,
       .help = "Write with each partition the tetrahedra of others that share a vertex with it; for .pvtu "
               "and .msh",
       .commands = writing},
      {.name = "cell-decomposition FILE",
       .place = at<&RunOptions::cell_decomposition>,
       .help = "Also write the partition of each tetrahedron as a list that OpenFOAM's decomposePar reads",
       .commands = writing}};
}

std::vector<Option> complex_options() {
  return {
      {.name = "domain",
       .words = {"enclosed", "box"},
       .place = choice_at<&RunOptions::complex, &PlcOptions::domain>,
       .help = "enclosed: mesh what the facets enclose; box: mesh a box around everything, so that points, "
               "segments and facets need not enclose anything",
       .details = "the space between the box and its contents is the last region",
       .commands = refining | Option::check | Option::info},
      {.name = "box-margin SHARE",
       .place = at<&RunOptions::complex, &PlcOptions::box_margin>,
       .low = 0.01,
       .high = 1000,
       .help = "Distance from the shape to the box of --domain box, relative to the largest side of the "
               "shape's bounding box",
       .commands = refining | Option::check | Option::info},
      {.name = "feature-angle DEGREES",
       .place = at<&RunOptions::complex, &PlcOptions::feature_angle>,
       .unit = Unit::degrees,
       .high = 180,
       .help =
           "Keep edges at which the surface turns by more than this angle; 0: keep every edge that is not "
           "flat"},
      {.name = "planar-tolerance T",
       .place = at<&RunOptions::complex, &PlcOptions::planar_tolerance>,
       .unit = Unit::of_diagonal,
       .high = 0.01,
       .help = "Neighbouring facets within this distance of one plane form one patch, relative to the "
               "diagonal; 0: exactly coplanar ones only"},
      {.name = "weld T",
       .place = at<&RunOptions::complex, &PlcOptions::weld>,
       .unit = Unit::of_diagonal,
       .high = 0.1,
       .help = "Points closer than this are merged, relative to the diagonal",
       .details = "other features that come this close without meeting make the complex invalid, see "
                  "[Limits](limits.md)",
       .commands = complexes},
      {.name = "repair",
       .words = {"auto", "none", "wrap"},
       .place = choice_at<&RunOptions::repair, &RepairOptions::mode>,
       .help = "auto: repair facets that do not form a valid complex; none: report them as an error; wrap: "
               "if repair fails or its result cannot be meshed, mesh a closed surface around everything",
       .details = "see [Repair](repair.md)",
       .commands = complexes},
      {.name = "repair-tolerance T",
       .place = at<&RunOptions::repair, &RepairOptions::tolerance>,
       .unit = Unit::of_diagonal,
       .high = 0.01,
       .help = "Repair treats features smaller than this as noise, relative to the diagonal",
       .commands = complexes},
      {.name = "feature-size F",
       .place = at<&RunOptions::repair, &RepairOptions::feature_size>,
       .high = 0.1,
       .help = "Collapse curves, narrow patches and sharp tips of patches that are smaller than this share "
               "of the target size and have no name, size or group; also walls and gaps thinner than that, "
               "if they cannot be meshed otherwise; 0: keep all",
       .details = "see [Features to the size](repair.md#features-to-the-size)",
       .commands = refining | Option::check},
      {.name = "wrap-offset T",
       .place = at<&RunOptions::repair, &RepairOptions::wrap_offset>,
       .unit = Unit::of_diagonal,
       .low = 1e-4,
       .high = 0.1,
       .help = "Distance from the input to the surface that --repair wrap puts around it, relative to the "
               "diagonal",
       .commands = complexes},
      {.name = "overlap",
       .words = {"first", "region"},
       .place = choice_at<&RunOptions::overlap>,
       .help = "first: the common part of solids of a CAD file belongs to the first one; region: it is a "
               "region of its own",
       .commands = complexes},
      {.name = "names FILE.json",
       .place = at<&RunOptions::names>,
       .help = "Names of patches, curves and regions, each with its number or a point on it; for formats "
               "that store names",
       .details = "an argument that begins with `{` is taken as the JSON itself, not as a path; see "
                  "[Names](names.md)",
       .commands = complexes},
      {.name = "name NAME=NUMBER",
       .place = at<&RunOptions::given_names>,
       .help = "Name a patch; NAME=1,2 names several, NAME=curve:4 a curve, NAME=region:1 a region",
       .details = "added to those of `--names`",
       .commands = complexes & ~unsigned{Option::programs}},
      {.name = "crease-angle DEGREES",
       .place = in_bounds<&Bounds::crease_angle>,
       .unit = Unit::degrees,
       .high = 90,
       .help = "Features that meet below this angle form a crease and get a collar",
       .commands = complexes}};
}

std::vector<Option> budget_options() {
  return {
      {.name = "max-vertices N",
       .place = in_mesh<&MeshOptions::max_vertices>,
       .default_text = "none",
       .help = "Maximum number of vertices of the triangulation, including those outside the regions"},
      {.name = "max-memory BYTES",
       .place = in_mesh<&MeshOptions::max_memory>,
       .unit = Unit::bytes,
       .default_text = "half of the machine's",
       .help = "Maximum memory for everything, such as 500M or 1.5G; 0: no limit",
       .details =
           "M and G are powers of 1024; reading is included, some 50 MB for libraries and stacks are not"},
      {.name = "time-limit SECONDS",
       .place = in_mesh<&MeshOptions::time_limit>,
       .unit = Unit::seconds,
       .default_text = "none",
       .help = "Maximum wall time in seconds, from reading to writing",
       .commands = everywhere}};
}

std::vector<Option> run_options() {
  return {
      {.name = "threads N",
       .place = in_mesh<&MeshOptions::threads>,
       .high = 1024,
       .help = "Maximum number of threads (0: all cores); the result does not depend on it",
       .details = "refinement uses them away from curves and corners, later stages everywhere",
       .commands = judging},
      {.name = "scale FACTOR",
       .place = at<&RunOptions::scale>,
       .low = 1e-100,
       .high = 1e100,
       .help =
           "Coordinates are multiplied by this when they are written: 0.001 converts millimetres to metres"},
      {.name = "scale FACTOR",
       .place = at<&RunOptions::scale>,
       .low = 1e-100,
       .high = 1e100,
       .help = "The mesh was written with --scale FACTOR; its coordinates are divided by this",
       .commands = Option::check},
      {.name = "findings N",
       .place = at<&RunOptions::findings>,
       .help = "List at most this many findings per guarantee",
       .commands = Option::check | Option::programs},
      {.name = "keep-invalid",
       .place = at<&RunOptions::keep_invalid>,
       .help = "Write the mesh even if it has flat, inverted or repeated elements",
       .details = "otherwise such a mesh, which no solver can use, is not written (exit code 7)",
       .commands = writing},
      {.name = "report FILE",
       .place = at<&RunOptions::reports>,
       .help = "Write all measurements, as JSON, or as a page for a browser (.html)",
       .details = "see [Reports](report.md)"},
      {.name = "trace FOLDER",
       .place = at<&RunOptions::trace_folder>,
       .help = "Write the steps of the run as .vtu files and trace.pvd, which ParaView plays",
       .details = "see [How it works](how_it_works.md#watch-a-run)",
       .commands = Option::mesh},
      {.name = "progress",
       .words = {"auto", "json", "none"},
       .place = choice_at<&RunOptions::progress>,
       .help = "auto: a bar on a terminal; json: one object per line; none: no progress",
       .details = "with `json`, `info` reports each prediction as soon as it is made",
       .commands = writing | Option::info},
      {.name = "verbose",
       .letter = 'v',
       .place = at<&RunOptions::verbose>,
       .help = "Print more: the time of each stage, statistics"},
      {.name = "quiet",
       .letter = 'q',
       .place = at<&RunOptions::quiet>,
       .help = "Print only errors, and repairs that change the shape by more than the tolerance",
       .commands = writing | Option::repair}};
}

std::vector<Option> rank_options() {
  return {{.name = "levels N",
           .place = at<&RunOptions::levels>,
           .high = 12,
           .help = "Number of times that every tetrahedron is cut into eight"},
          {.name = "slack DEGREES",
           .place = at<&RunOptions::slack>,
           .unit = Unit::degrees,
           .high = 180,
           .help = "Degrees by which dihedral angles may go beyond those of the coarse mesh"}};
}

/// Adds `options` as rows; `group` and `commands` apply to rows that do not set their own. In `options`, the
/// name of an option is followed by the name of its value.
void append(std::vector<Option>& table, std::vector<Option> options, const char* group, unsigned commands) {
  for (Option& option : options) {
    const std::size_t space = std::min(option.name.find(' '), option.name.size());
    option.value_name = option.words.empty() ? option.name.substr(std::min(space + 1, option.name.size()))
                                             : fmt::format("{}", fmt::join(option.words, "|"));
    option.name.resize(space);
    if (option.group.empty()) option.group = group;
    if (option.commands == 0) option.commands = commands;
    table.push_back(std::move(option));
  }
}

std::vector<Option> made_table() {
  std::vector<Option> table;
  append(table, size_options(), size_group, sizing);
  append(table, quality_options(), quality_group, meshing);
  append(table, element_options(), "Elements", sizing);
  append(table, split_options(), "Sides of their own (contact, cracks)", Option::mesh | Option::programs);
  append(table, layer_options(), "Boundary layers", Option::mesh | Option::programs);
  append(table, periodic_options(), "Periodic faces (representative cells)", Option::mesh | Option::programs);
  append(table, partition_options(), partitions_group, meshing);
  append(table, complex_options(), complex_group, everywhere);
  append(table, budget_options(), budget_group, meshing);
  append(table, run_options(), "Options", writing);
  append(table, rank_options(), "Refinement on many ranks", Option::ranks);
  return table;
}

}  // namespace

const std::vector<Option>& option_table() {
  static const std::vector<Option> table = made_table();
  return table;
}

}  // namespace collarmesh
