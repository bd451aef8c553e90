#pragma once

#include <string>
#include <variant>
#include <vector>

#include "cad_files.h"
#include "collarmesh/check.h"
#include "collarmesh/coarsen.h"
#include "collarmesh/improve.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "collarmesh/mesher.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/repair.h"
#include "exit_code.h"

namespace CLI {
class App;
}

namespace collarmesh::cli {

enum class ProgressStyle { automatic, json, none };

/// How files become a complex; all commands share it.
struct ComplexArguments {
  PlcOptions plc;
  RepairOptions repair;
  SolidOverlap overlap = SolidOverlap::first;
  double crease_angle = 60;  ///< degrees
  std::string names;         ///< path of a file that names features; empty: none
};

/// `collarmesh INPUT... -o OUT`
struct MeshArguments {
  std::vector<std::string> inputs;
  std::string output;
  ComplexArguments complex;
  MeshOptions mesh;
  std::string size_field;                           ///< path, empty: none
  bool coarsen = true;                              ///< as few tets as the sizes ask for
  double thin_angle = CoarsenOptions{}.thin_angle;  ///< degrees, where it coarsens
  unsigned improve = 2;                             ///< level; 0: leave the elements as they are
  unsigned order = 1;                               ///< of the cells, 1 or 2
  unsigned partitions = 0;                          ///< the tets are divided among so many; 0: they are not
  io::GhostCells ghost_cells = io::GhostCells::none;
  std::string cell_decomposition;           ///< path of OpenFOAM's list of partitions, empty: none
  double min_dihedral = 0;                  ///< degrees, in place of the level's; 0: the level's
  double scale = 1;                         ///< of the coordinates that are written
  std::string input_format, output_format;  ///< extensions with their dot; empty: those of the files
  unsigned threads = 0;                     ///< at most; 0: as many as there are cores
  std::vector<std::string> reports;         ///< paths
  ProgressStyle progress = ProgressStyle::automatic;
  bool verbose = false;
  bool quiet = false;
  bool tell_losses = false;  ///< say what the output's format has no place for
};

/// `collarmesh check MESH --against INPUT...`
struct CheckArguments {
  std::string mesh;
  std::vector<std::string> inputs;
  ComplexArguments complex;
  CheckOptions check;
  double time_limit = 0;  ///< seconds; 0: none
  bool json = false;
};

/// `collarmesh info INPUT...`
struct InfoArguments {
  std::vector<std::string> inputs;
  ComplexArguments complex;
  std::vector<double>
      predicted_sizes;     ///< 0: the size in `mesh`, or its default; empty: nothing is predicted
  MeshOptions mesh;        ///< its sizes and its distance
  std::string size_field;  ///< path, empty: none
  unsigned order = 1;      ///< of the cells, 1 or 2
  double time_limit = 0;   ///< seconds; 0: none
  bool json = false;
};

/// `collarmesh convert IN... -o OUT`: a surface becomes a mesh as in MeshArguments if OUT is one.
/// "-" among the inputs is standard input, as output it is standard output.
struct ConvertArguments {
  MeshArguments mesh;
  std::vector<std::string> meshing_options;  ///< those given that only meshing has a use for
  bool repair = false;  ///< surfaces that become surfaces, too: --repair was given and is not none
};

/// `collarmesh repair IN... -o OUT`; "-" as in ConvertArguments.
struct RepairArguments {
  std::vector<std::string> inputs;
  std::string output;
  ComplexArguments complex;
  std::string input_format, output_format;  ///< extensions with their dot; empty: those of the files
  std::string report;                       ///< path, empty: none
  double time_limit = 0;                    ///< seconds; 0: none
  bool json = false;
  bool quiet = false;
};

using Arguments =
    std::variant<MeshArguments, CheckArguments, InfoArguments, ConvertArguments, RepairArguments>;

/// The options of meshing, all but the files, for another program that meshes; and what one of them alone
/// cannot tell, which throws CLI::ValidationError.
void add_run_options(CLI::App& app, MeshArguments& arguments);
void check_run_arguments(const MeshArguments& arguments);

/// Understand a command line. When there is nothing to run (help, version, a mistake) the text has
/// been printed and the exit code is returned instead.
std::variant<Arguments, ExitCode> parse(int argc, const char* const* argv);

}  // namespace collarmesh::cli
