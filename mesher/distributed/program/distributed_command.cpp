#include "distributed_command.h"

#include <fmt/format.h>
#include <petscsys.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <thread>
#include <type_traits>

#include "calls.h"
#include "collarmesh/distributed.h"
#include "command/guarded.h"
#include "command/make_mesh.h"
#include "command/usable.h"
#include "common/stopwatch.h"
#include "distributed_arguments.h"
#include "files/complex_input.h"
#include "files/file_groups.h"
#include "files/input_files.h"
#include "process/machine.h"
#include "report/json_text.h"

namespace collarmesh::distributed {

namespace {

/// An owner of MPI and PETSc, which are initialized during its lifetime.
class Session {
 public:
  Session() {
    PetscOptionsSetValue(nullptr, "-no_signal_handler", "true");  // the program has its own handler
    PetscInitializeNoArguments();
  }
  ~Session() { PetscFinalize(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
};

/// Ends all ranks because they can no longer act together; one of them prints the reason.
[[noreturn]] void end_all(process::Process& process, process::ExitCode code, const std::string& message) {
  const Ranks ranks(MPI_COMM_WORLD);
  // If several ranks fail at once, the first one reports and ends the others before they do.
  std::this_thread::sleep_for(std::chrono::milliseconds(200) * ranks.rank);
  process.files.abandon();
  const std::string text = fmt::format("collarmesh: {}\n", message);
  if (write(STDERR_FILENO, text.data(), text.size()) < 0) {
    // If the message cannot be printed, the exit code alone has to tell of the failure.
  }
  MPI_Abort(MPI_COMM_WORLD, static_cast<int>(code));
  std::_Exit(static_cast<int>(code));
}

[[noreturn]] void end_without_memory(process::Process& process, const PetscOutOfMemory& failure) {
  end_all(
      process, process::ExitCode::budget_hit,
      fmt::format("there is not enough memory ({}); raise --max-memory, use more ranks, or make fewer levels",
                  failure.what()));
}

/// Does work on each rank, like `agree`; the work may also throw Stopped. If it does so on some ranks, all
/// ranks throw the Stopped of the first of these.
void together(const std::function<void()>& work) {
  std::exception_ptr thrown;
  std::optional<process::Stopped> stopped;
  agree(MPI_COMM_WORLD, [&] {
    try {
      work();
    } catch (const process::Stopped& reason) {
      stopped = reason;
    }
  });
  const Ranks ranks(MPI_COMM_WORLD);
  int first = stopped ? ranks.rank : ranks.count;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (first == ranks.count) return;
  int code = stopped ? static_cast<int>(stopped->code) : 0;
  MPI_Bcast(&code, 1, MPI_INT, first, MPI_COMM_WORLD);
  const std::string message = broadcast(MPI_COMM_WORLD, stopped ? stopped->what() : "", first);
  throw process::Stopped(static_cast<process::ExitCode>(code), message);
}

/// The hash FNV-1a.
class Hash {
 public:
  void add(const void* bytes, std::size_t count) {
    const auto* byte = static_cast<const unsigned char*>(bytes);
    for (std::size_t i = 0; i < count; ++i) value_ = (value_ ^ byte[i]) * 0x100000001b3ULL;
  }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void add(const std::vector<T>& values) { add(values.data(), values.size() * sizeof(T)); }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// Returns the first rank whose value differs from rank 0's; -1 if there is none.
int first_that_differs(std::uint64_t value) {
  const Ranks ranks(MPI_COMM_WORLD);
  std::uint64_t of_first = value;
  MPI_Bcast(&of_first, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  int first = value == of_first ? ranks.count : ranks.rank;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  return first == ranks.count ? -1 : first;
}

std::string host_of(int rank) {
  std::array<char, MPI_MAX_PROCESSOR_NAME + 1> name{};
  int length = 0;
  MPI_Get_processor_name(name.data(), &length);
  MPI_Bcast(name.data(), static_cast<int>(name.size()), MPI_CHAR, rank, MPI_COMM_WORLD);
  return fmt::format("rank {} ({})", rank, name.data());
}

void require_equal_command_lines(int argc, const char* const* argv) {
  Hash hash;
  for (int i = 1; i < argc; ++i) hash.add(argv[i], std::strlen(argv[i]) + 1);
  if (const int other = first_that_differs(hash.value()); other >= 0)
    throw OptionError(fmt::format("{} has other options than rank 0; start all ranks with the same options",
                                  host_of(other)));
}

void require_equal_files(const command::MeshArguments& arguments) {
  std::vector<std::string> paths = arguments.inputs;
  for (const std::string& path : {arguments.names, arguments.size_field_file})
    if (!path.empty() && !path.starts_with('{')) paths.push_back(path);
  for (const std::string& path : paths) {
    Hash hash;
    together([&] {
      std::ifstream file(files::existing_file(path), std::ios::binary);
      std::vector<char> block(1 << 16);
      while (file.read(block.data(), static_cast<std::streamsize>(block.size())), file.gcount() > 0)
        hash.add(block.data(), static_cast<std::size_t>(file.gcount()));
    });
    if (const int other = first_that_differs(hash.value()); other >= 0)
      throw ReadError(
          fmt::format("{}: differs on {} from the file on rank 0; put the same file on all machines", path,
                      host_of(other)));
  }
}

std::uint64_t fingerprint(const Plc& plc) {
  Hash hash;
  hash.add(plc.points);
  hash.add(plc.triangles);
  for (const Plc::Curve& curve : plc.curves) {
    hash.add(curve.points);
    hash.add(&curve.tag, sizeof curve.tag);
  }
  for (const Plc::Patch& patch : plc.patches) {
    hash.add(&patch.tag, sizeof patch.tag);
    hash.add(patch.regions.data(), sizeof patch.regions);
  }
  return hash.value();
}

/// The data of the input on every rank, and the mesh that rank 0 made of it.
struct Coarse {
  command::MadeMesh made;  ///< ranks other than 0 only have the input and the complex
  Shape shape() const {
    const Plc& plc = made.run.plc;
    return {plc, made.input->has_cad() ? made.input->exact_geometry(plc) : ExactGeometry{},
            distance_of(options, plc.bounds.diagonal())};
  }
  PipelineOptions options;
};

/// Gives all ranks the repair options of rank 0.
void share(RepairOptions& repair, bool is_first) {
  struct Numbers {
    RepairMode mode;
    double tolerance, wrap_offset;
    bool wrap_at_once;
    double feature_size;
    std::optional<double> target_size;
    std::size_t max_work;
  };
  const auto of_first = [&]<class Value>(const std::vector<Value>& values) {
    return gathered(MPI_COMM_WORLD, is_first ? values : std::vector<Value>());
  };
  const Numbers numbers =
      of_first(std::vector<Numbers>{{repair.mode, repair.tolerance, repair.wrap_offset, repair.wrap_at_once,
                                     repair.feature_size, repair.target_size, repair.max_work}})
          .front();
  repair = {.mode = numbers.mode,
            .tolerance = numbers.tolerance,
            .wrap_offset = numbers.wrap_offset,
            .wrap_at_once = numbers.wrap_at_once,
            .feature_size = numbers.feature_size,
            .target_size = numbers.target_size,
            .kept_patches = of_first(repair.kept_patches),
            .kept_curves = of_first(repair.kept_curves),
            .max_work = numbers.max_work};
}

/// Makes the mesh on rank 0, and its complex on the other ranks.
Coarse make_coarse(process::Process& process, const command::MeshArguments& arguments) {
  const Ranks ranks(MPI_COMM_WORLD);
  Coarse coarse;
  command::MeshArguments first_order = arguments;
  first_order.order = 1;
  coarse.options = first_order;
  together([&] {
    if (ranks.rank == 0) coarse.made = command::make_mesh(process, first_order);
  });
  share(coarse.made.repair, ranks.rank == 0);
  together([&] {
    if (ranks.rank == 0) return;
    coarse.made.input = command::read_inputs(process, first_order);
    coarse.made.run.plc = coarse.made.input->build(first_order.complex, coarse.made.repair);
  });
  if (const int other = first_that_differs(fingerprint(coarse.made.run.plc)); other >= 0)
    throw std::runtime_error(
        fmt::format("{} makes another complex of the input than rank 0; run the same program on all ranks",
                    host_of(other)));
  return coarse;
}

std::string text_of(const LevelReport& level, unsigned number) {
  std::string text = fmt::format("level {}: {} tets in {:.2f} s; {} vertices on smooth or exact features",
                                 number, level.tets, level.seconds, level.on_features);
  if (level.spoilt > 0 || level.made_room > 0)
    text += fmt::format(
        "; placing these vertices made {} tets poor or invalid; to mend tets, other vertices were moved {} "
        "times",
        level.spoilt, level.made_room);
  if (level.drawn_back > 0)
    text += fmt::format(
        "; {} vertices did not reach their places on the shape and are at most {:.3g} away from them",
        level.drawn_back, level.farthest_off);
  return text + '\n';
}

std::string angles_text(const AngleBounds& angles) {
  std::string text = fmt::format("{:.4g} to {:.4g} degrees", angles.least[0], angles.most[0]);
  if (angles.most[1] > 0)
    text += fmt::format(", in collars {:.4g} to {:.4g}", angles.least[1], angles.most[1]);
  return text;
}

std::string text_of(const Certificate& c, const AngleBounds& coarse) {
  return fmt::format(
      "mesh: {} tets, {} vertices, {} faces on patches, {} edges on curves\n"
      "dihedral angles: {} (coarse: {})\n"
      "fingerprint: {:016x}{:016x}\n"
      "{}\n",
      c.tets, c.vertices, c.faces, c.edges, angles_text(c.angles), angles_text(coarse), c.fingerprint[0],
      c.fingerprint[1],
      c.passed() ? std::string("certificate: every guarantee holds")
                 : fmt::format("certificate: {} findings", c.findings_total));
}

nlohmann::ordered_json json_of(const AngleBounds& a) {
  nlohmann::ordered_json json{{"min_dihedral", a.least[0]}, {"max_dihedral", a.most[0]}};
  if (a.most[1] > 0) {
    json["min_collar_dihedral"] = a.least[1];
    json["max_collar_dihedral"] = a.most[1];
  }
  return json;
}

template <class Map>
nlohmann::ordered_json json_by_tag(const Map& values) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [tag, value] : values) json[std::to_string(tag)] = value;
  return json;
}

/// All results of a run.
struct Report {
  std::vector<LevelReport> levels;
  std::optional<OrderReport> order;
  Certificate certificate;
  AngleBounds coarse;
  std::string partitioner;
  double certify_seconds = 0, write_seconds = 0;
  std::vector<double> peak_bytes;  ///< by rank

  nlohmann::ordered_json json() const {
    nlohmann::ordered_json json;
    json["ranks"] = certificate.tets_of_ranks.size();
    json["partitioner"] = partitioner;
    json["tets"] = certificate.tets;
    json["vertices"] = certificate.vertices;
    json["tets_of_ranks"] = certificate.tets_of_ranks;
    json["peak_bytes_of_ranks"] = peak_bytes;
    json["fingerprint"] =
        fmt::format("{:016x}{:016x}", certificate.fingerprint[0], certificate.fingerprint[1]);
    json["coarse_angles"] = json_of(coarse);
    json["angles"] = json_of(certificate.angles);
    json["largest_distance"] = certificate.largest_distance;
    json["region_volumes"] = json_by_tag(certificate.region_volumes);
    json["patch_areas"] = json_by_tag(certificate.patch_areas);
    json["curve_lengths"] = json_by_tag(certificate.curve_lengths);
    for (const LevelReport& level : levels)
      json["levels"].push_back({{"tets", level.tets},
                                {"seconds", level.seconds},
                                {"on_features", level.on_features},
                                {"spoilt", level.spoilt},
                                {"made_room", level.made_room},
                                {"drawn_back", level.drawn_back},
                                {"farthest_off", level.farthest_off}});
    if (order)
      json["second_order"] = {{"nodes", order->nodes},
                              {"curved", order->curved},
                              {"straightened", order->straightened},
                              {"farthest_off", order->farthest_off}};
    json["certify_seconds"] = certify_seconds;
    json["write_seconds"] = write_seconds;
    json["guarantees_hold"] = certificate.passed();
    json["findings_total"] = certificate.findings_total;
    json["findings"] = nlohmann::ordered_json::array();
    for (const Finding& finding : certificate.findings)
      json["findings"].push_back({{"guarantee", finding.guarantee}, {"message", finding.message}});
    return json;
  }
};

double peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return 1024 * std::stod(line.substr(6));
  return 0;
}

/// Writes the files of the mesh into a temporary folder that rank 0 creates. Rank 0 moves them to their
/// places when all ranks are done.
void write_files(process::Process& process, const command::MeshArguments& arguments, const ParallelMesh& mesh,
                 Report& report) {
  const bool first = Ranks(MPI_COMM_WORLD).rank == 0;
  const Stopwatch stopwatch;
  std::optional<process::StagedFile> staged, staged_report;
  std::string place;
  together([&] {
    if (!first) return;
    staged.emplace(process.files, arguments.output);
    staged->write([&](const std::string& path) { place = path; });
  });
  place = broadcast(MPI_COMM_WORLD, place);
  try {
    writes_pieces(arguments) ? mesh.write_pvtu(place) : mesh.write_h5(place);
  } catch (const PetscOutOfMemory& failure) {
    end_without_memory(process, failure);
  } catch (const PetscFailure& failure) {
    end_all(process, process::ExitCode::cannot_write,
            fmt::format("{}: cannot be written ({}); is the disk full?", arguments.output, failure.what()));
  } catch (const WriteError& error) {  // all ranks throw it; the message has the temporary name
    const std::filesystem::path target = arguments.output, staged_at = place;
    throw WriteError(process::with_folder(error.what(), staged_at.parent_path(), target.parent_path()));
  }
  report.write_seconds = stopwatch.seconds();
  report.peak_bytes = gathered(MPI_COMM_WORLD, std::vector{peak_bytes()});
  together([&] {
    if (!first) return;
    if (!arguments.reports.empty()) {
      staged_report.emplace(process.files, arguments.reports.front());
      staged_report->write([&](const std::string& path) {
        process::write_text(path, report::json_text(report.json(), 1) + "\n");
      });
    }
    process.files.commit({&*staged, staged_report ? &*staged_report : nullptr});
  });
}

void require_places(process::Process& process, const command::MeshArguments& arguments) {
  process.files.require_writable(arguments.output, files::files_written(arguments.output));
  for (const std::string& report : arguments.reports) process.files.require_writable(report);
}

process::ExitCode mesh_distributed(process::Process& process, const command::MeshArguments& arguments) {
  const Ranks ranks(MPI_COMM_WORLD);
  process.interrupts.set_time_limit(arguments.mesh.time_limit);
  process::limit_memory(arguments.mesh.max_memory);
  together([&] {
    if (ranks.rank == 0) require_places(process, arguments);
  });
  require_equal_files(arguments);
  Coarse coarse = make_coarse(process, arguments);
  const auto stop = [&] { together([&] { process.interrupts.stop_if_asked(); }); };
  if (!arguments.quiet && ranks.rank == 0)
    process.console.tell(
        "coarse mesh: {} tets; {}\n", coarse.made.run.result.mesh.tets.size(),
        coarse.made.run.guarantees_hold() ? "every guarantee holds" : coarse.made.run.missed());
  const auto require_usable = [&](const auto& findings) {
    for (const auto& finding : findings)
      if (!arguments.keep_invalid) command::require_usable(finding.guarantee, finding.message);
  };
  together([&] { require_usable(coarse.made.run.check.findings); });
  int holds = coarse.made.run.guarantees_hold() ? 1 : 0;
  MPI_Bcast(&holds, 1, MPI_INT, 0, MPI_COMM_WORLD);
  const Shape shape = coarse.shape();
  ParallelMesh mesh(MPI_COMM_WORLD, coarse.made.run.result.mesh, coarse.made.run.plc,
                    arguments.mesh.bounds.collar_angle);
  coarse.made.run.result.mesh = {};
  Report report;
  report.coarse = mesh.coarse_angles();
  report.partitioner = mesh.partitioner();
  for (unsigned level = 0; level < arguments.levels; ++level) {
    stop();
    report.levels.push_back(mesh.refine(shape));
    if (!arguments.quiet) process.console.tell("{}", text_of(report.levels.back(), level + 1));
  }
  stop();
  if (arguments.order == 2) report.order = mesh.raise_order(shape);
  if (report.order && !arguments.quiet)
    process.console.tell(
        "second order: {} nodes, {} of them not at the middles of their edges; {} straightened, at most "
        "{:.3g} from their places on the shape\n",
        report.order->nodes, report.order->curved, report.order->straightened, report.order->farthest_off);
  stop();
  const Stopwatch stopwatch;
  report.certificate = mesh.certify(shape, arguments.slack);
  report.certify_seconds = stopwatch.seconds();
  for (const Finding& finding : report.certificate.findings)
    process.console.tell("{}: {}\n", finding.guarantee, finding.message);
  require_usable(report.certificate.findings);
  mesh.scale(arguments.scale);
  stop();
  write_files(process, arguments, mesh, report);
  if (!arguments.quiet) process.console.tell("{}", text_of(report.certificate, report.coarse));
  return report.certificate.passed() && holds != 0 ? process::ExitCode::success
                                                   : process::ExitCode::guarantee_missed;
}

}  // namespace

process::ExitCode run(process::Process& process, int argc, char** argv) {
  // Install the handlers before MPI is initialized: MPI writes files of its own, and one that grows too large
  // must not end the program.
  process.catch_signals();
  const Session session;
  if (Ranks(MPI_COMM_WORLD).rank != 0) process.console.be_silent();
  process.catch_crashes(  // replaces PETSc's handler
      "collarmesh: a library has crashed, as some do when memory is used up; raise --max-memory, or use more "
      "ranks\n",
      "collarmesh: a library has crashed; please report it with the input and the options\n");
  // Watch only until the result is known. After a rank has ended with an error (which has been reported by
  // then), mpirun asks ranks that are still in MPI_Finalize to stop.
  const process::ExitCode result = process.run_interruptible([&] {
    return command::guarded(process, [&]() -> process::ExitCode {
      try {
        require_equal_command_lines(argc, argv);
        const std::variant<command::MeshArguments, process::ExitCode> parsed =
            parse(process.console, argc, argv);
        if (const process::ExitCode* code = std::get_if<process::ExitCode>(&parsed)) return *code;
        return mesh_distributed(process, std::get<command::MeshArguments>(parsed));
      } catch (const PetscOutOfMemory& failure) {
        end_without_memory(process, failure);
      } catch (const PetscFailure& failure) {
        end_all(process, process::ExitCode::internal_error, failure.what());
      }
    });
  });
  for (const int number : {SIGINT, SIGTERM}) std::signal(number, SIG_DFL);
  return result;
}

}  // namespace collarmesh::distributed
