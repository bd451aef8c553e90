#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace collarmesh::files {

/// Returns the files that writing `path` makes: the file itself and the further files that its format needs.
/// `format` overrides the extension. Pieces of a .pvtu are listed only if they exist already.
std::vector<std::filesystem::path> files_written(const std::filesystem::path& path,
                                                 const std::string& format = {});

/// Returns whether meshes of this format consist of several files.
bool is_of_several_files(const std::string& format);

/// Returns whether writing `path` may make or replace `file`. Pieces of a .pvtu need not exist yet.
bool may_write(const std::filesystem::path& path, const std::string& format,
               const std::filesystem::path& file);

/// Returns the files that reading `path` may read; for "-", the file that is standard input.
std::vector<std::filesystem::path> files_read(const std::filesystem::path& path,
                                              const std::string& format = {});

/// Returns whether two paths name the same file, by any name or link.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Describes an input that an output would overwrite: "part.node, a file of the input part.poly"; empty:
/// none.
std::string overwritten(const std::vector<std::filesystem::path>& written,
                        const std::vector<std::string>& inputs, const std::string& input_format);

}  // namespace collarmesh::files
