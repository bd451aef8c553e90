#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "collarmesh/geometry.h"
#include "collarmesh/tet_mesh.h"
#include "common/group_names.h"
#include "common/lower_case.h"

/// Names of groups of cells as formats write and read them.
namespace collarmesh::io {

/// Return a text with `_` in place of each character that is no ASCII letter, digit or `-`; the second
/// function also turns letters into capitals.
std::string word(std::string text);
std::string capital_word(std::string text);

/// Return the group's name, changed like a text by `word` and `capital_word`. The second function also puts
/// `N_` before a name that does not begin with a letter, as Abaqus and Ansys require.
std::string word_name(const TetMesh& mesh, std::size_t dimension, Tag tag);
std::string capital_name(const TetMesh& mesh, std::size_t dimension, Tag tag);

/// Returns the tag that a name made of dimension and tag stands for: 7 for "patch_7" or "Face7", in upper or
/// lower case. Nothing for other names.
std::optional<Tag> tag_of_group_name(std::size_t dimension, std::string_view name);

/// Returns whether a name was given, not made of dimension and tag ("patch_7"). Names such as "Face7", which
/// CAD shapes have, count as given.
bool is_given_name(std::size_t dimension, std::string_view name);

/// The tags of the groups in another program's file: groups with names of ours get the tags that these stand
/// for; each other group gets the number after the largest tag so far in its dimension, or 1 if it is the
/// first.
class GroupTags {
 public:
  Tag find(std::size_t dimension, const std::string& name);

 private:
  std::array<std::map<std::string, Tag>, 4> known_;
  std::array<Tag, 4> next_{1, 1, 1, 1};
};

/// Names that are all different and not too long: a second "a" becomes "a_2".
class DistinctNames {
 public:
  /// `longest` is in bytes.
  explicit DistinctNames(std::size_t longest) : longest_(longest) {}
  std::string add(const std::string& name);

 private:
  std::size_t longest_;
  std::set<std::string> known_;
};

}  // namespace collarmesh::io
