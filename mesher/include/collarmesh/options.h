#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "collarmesh/partition.h"
#include "collarmesh/pipeline.h"

/// The table of options, from which the command line, its help, manual page and completions, the Python
/// package, reports, the page about options and the add-on for FreeCAD are made.
namespace collarmesh {

/// The owner of the common part of several solids of a CAD file.
enum class SolidOverlap {
  first,  ///< the first of these solids, or another one that lies wholly inside it
  region  ///< the common part becomes a region of its own
};

enum class ProgressStyle { automatic, json, off };

/// The options of a run from files to a file. Strings are paths; empty: none.
struct RunOptions : PipelineOptions {
  SolidOverlap overlap = SolidOverlap::first;
  std::string names = {};                     ///< names of features, by number or place: a file or its text
  std::vector<std::string> given_names = {};  ///< names of features, "fixed=11"
  std::string size_field_file = {};           ///< the file from which `mesh.size_field` is read
  GhostCells ghost_cells = GhostCells::off;
  std::string cell_decomposition = {};  ///< file for OpenFOAM's list of partitions
  double scale = 1;                     ///< factor of the coordinates that are written
  TriangleElements triangle_elements = TriangleElements::shell;
  std::vector<std::string> reports = {};
  std::string trace_folder = {};  ///< folder for the steps of the run
  ProgressStyle progress = ProgressStyle::automatic;
  unsigned levels = 1;        ///< number of times that collarmesh-mpi cuts every tet into eight
  double slack = 10;          ///< degrees by which angles after these cuts may go beyond those of the coarse
                              ///< mesh
  bool keep_invalid = false;  ///< write meshes with elements that no solver can use, too
  bool verbose = false, quiet = false;
  std::size_t findings = 20;  ///< findings that `check` lists for each guarantee
};

/// The value of an option; for an enumeration, its word.
using OptionValue =
    std::variant<bool, std::uint64_t, double, std::string, std::map<Tag, double>, std::vector<std::string>>;

/// An option: its name, the range of its values and its help.
struct Option {
  enum class Kind { flag, choice, count, number, text, texts, sizes };
  enum class Unit { number, length, degrees, of_diagonal, ratio, seconds, bytes };
  /// Bits of the commands that take the option. `programs` stands for callers of the mesher such as Python
  /// and FreeCAD, which have no options about output files and messages.
  enum Command : unsigned {
    mesh = 1,
    check = 2,
    info = 4,
    convert = 8,
    repair = 16,
    programs = 32,
    remesh = 64,
    ranks = 128  ///< collarmesh-mpi, which also takes those of `mesh`
  };
  /// The member of RunOptions that holds the value.
  struct Place {
    Kind kind;  ///< kind of value, given by the member's type
    OptionValue (*get)(const Option&, const RunOptions&);
    void (*set)(const Option&, RunOptions&, const OptionValue&);
  };

  std::string name;                     ///< long name, "size-min"
  char letter = 0;                      ///< the short name; 0: none
  std::string value_name = {};          ///< the name of its value, "LENGTH"
  std::vector<std::string> words = {};  ///< the words of a choice, in the order of the enumeration; for a
                                        ///< bool, the words for true and false
  Place place;
  Unit unit = Unit::number;
  double low = 0, high = std::numeric_limits<double>::infinity();  ///< range of a number
  bool finer = false;                                              ///< makes some elements finer than `size`
  bool zero = false;              ///< 0 is allowed although it is outside the range
  std::string default_text = {};  ///< text shown in place of a value that is 0 or empty and stands for a
                                  ///< default or for none
  std::string group = {};         ///< heading in the help
  std::string help = {};          ///< a clause without a full stop; text after a semicolon is less important
  std::string details = {};       ///< further clauses, for pages
  unsigned commands = 0;

  Kind kind() const { return place.kind; }
  std::string key() const;  ///< Returns the name with "_" for "-", as in Python and in reports.
  OptionValue get(const RunOptions& options) const { return place.get(*this, options); }
  void set(RunOptions& options, const OptionValue& value) const { place.set(*this, options, value); }

  bool is_for(Command command) const { return (commands & command) != 0; }
  bool is_repeatable() const { return kind() == Kind::texts || kind() == Kind::sizes; }

  /// Reads the value from text; appends it if the option may be repeated. Returns false if the text does not
  /// fit.
  bool read(const std::string& text, RunOptions& options) const;
  /// Returns whether a value of the option's kind is in its range or among its words.
  bool fits(const OptionValue& value) const;
  /// Describes the allowed values, such as "a number from 0 to 0.1".
  std::string fitting() const;
  /// Returns the default as text.
  std::string default_value() const;
};

/// Returns all options, in the order of the help. Some have a second row for another command.
const std::vector<Option>& option_table();

/// Returns the options with the changes that their `mesh.profile` makes.
RunOptions with_profile(RunOptions options);

/// Throws OptionError for values out of the range of their option and for values that contradict each other.
void validate(const RunOptions& options);

/// Converts "1.5G" to bytes; K, M, G and T are powers of 1024, in either case. Returns nothing for other
/// text.
std::optional<std::size_t> read_bytes(std::string_view text);

/// Converts "7=0.25" to {7, 0.25}. Returns nothing unless the text is a whole number and a positive length.
std::optional<std::pair<Tag, double>> read_tag_value(std::string_view text);

}  // namespace collarmesh
