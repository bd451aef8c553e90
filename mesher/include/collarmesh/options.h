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

#include "collarmesh/io/tet_mesh_io.h"
#include "collarmesh/pipeline.h"

/// The table of options: the command line, its help, manual page and completions, the Python package,
/// reports, the page about options and the add-on for FreeCAD are made from it.
namespace collarmesh {

/// Who gets what several solids of a CAD file have in common?
enum class SolidOverlap {
  first,  ///< the first one, or the one that lies wholly inside it
  region  ///< it becomes a region of its own
};

enum class ProgressStyle { automatic, json, off };

/// What can be asked of a run from files to a file. Strings are paths; empty: none.
struct RunOptions : PipelineOptions {
  SolidOverlap overlap = SolidOverlap::first;
  std::string names = {};                     ///< of features, by number or place
  std::vector<std::string> given_names = {};  ///< of features, "fixed=11"
  std::string size_field_file = {};           ///< where `mesh.size_field` is read from
  io::GhostCells ghost_cells = io::GhostCells::none;
  std::string cell_decomposition = {};  ///< OpenFOAM's list of partitions
  double scale = 1;                     ///< of the coordinates that are written
  std::vector<std::string> reports = {};
  ProgressStyle progress = ProgressStyle::automatic;
  bool verbose = false, quiet = false;
  std::size_t findings = 20;  ///< listed for each guarantee, by `check`
};

/// The value of an option. Words stand for enumerations.
using OptionValue =
    std::variant<bool, std::uint64_t, double, std::string, std::map<Tag, double>, std::vector<std::string>>;

/// An option: its name, what it may be, and what it is for.
struct Option {
  enum class Kind { flag, choice, count, number, text, texts, sizes };
  enum class Unit { number, length, degrees, of_diagonal, ratio, seconds, bytes };
  /// Who takes it, bits: the commands, and programs that call the mesher, as Python and FreeCAD. These do
  /// without options about files that are written and about messages.
  enum Command : unsigned { mesh = 1, check = 2, info = 4, convert = 8, repair = 16, programs = 32 };
  /// Where in the RunOptions the value stands.
  struct Place {
    Kind kind;  ///< by its type
    OptionValue (*get)(const Option&, const RunOptions&);
    void (*set)(const Option&, RunOptions&, const OptionValue&);
  };

  std::string name;             ///< "size-min"
  char letter = 0;              ///< the short name, if there is one
  std::string value_name = {};  ///< what its value is called, "LENGTH"
  std::vector<std::string> words =
      {};  ///< of a choice, in the order of the enumeration; of a bool: true, false
  Place place;
  Unit unit = Unit::number;
  double low = 0, high = std::numeric_limits<double>::infinity();  ///< range of a number
  bool finer = false;                                              ///< makes some elements finer than `size`
  bool zero = false;              ///< 0 is allowed, too, although it is out of range
  std::string default_text = {};  ///< in place of 0 or nothing, where that stands for a default or for none
  std::string group = {};         ///< a heading
  std::string help = {};     ///< a clause without a full stop; what follows a semicolon is less important
  std::string details = {};  ///< further clauses, for pages
  unsigned commands = 0;

  Kind kind() const { return place.kind; }
  std::string key() const;  ///< the name with "_" for "-", as in Python and in reports
  OptionValue get(const RunOptions& options) const { return place.get(*this, options); }
  void set(RunOptions& options, const OptionValue& value) const { place.set(*this, options, value); }

  bool is_for(Command command) const { return (commands & command) != 0; }
  bool is_repeatable() const { return kind() == Kind::texts || kind() == Kind::sizes; }

  /// Read the value from text; one that may be repeated is added to those before. False if the text does not
  /// fit.
  bool read(const std::string& text, RunOptions& options) const;
  bool fits(const OptionValue& value) const;
  /// Describe the values that fit, "a number from 0 to 0.1".
  std::string fitting() const;
  /// The default as text.
  std::string default_value() const;
};

/// All options, in the order of the help. Some have a second row for another command.
const std::vector<Option>& option_table();

/// Throw OptionError for values out of the range of their option, and for those that contradict each other.
void validate(const RunOptions& options);

/// "1.5G" in bytes; K, M, G and T are powers of 1024, in either case. Nothing if it is no such size.
std::optional<std::size_t> read_bytes(std::string_view text);

/// "7=0.25" is {7, 0.25}. Nothing unless that is a whole number and a positive length.
std::optional<std::pair<Tag, double>> read_tag_value(std::string_view text);

}  // namespace collarmesh
