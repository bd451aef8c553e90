#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace collarmesh::files {

/// The files that writing `path` makes: it and those that the format (its extension, or `format`) puts beside
/// it; of the pieces of a .pvtu those that are there already.
std::vector<std::filesystem::path> files_written(const std::filesystem::path& path,
                                                 const std::string& format = {});

/// Do meshes of this format lie in several files?
bool is_of_several_files(const std::string& format);

/// May writing `path` make this file, too? Pieces of a .pvtu need not be there yet.
bool may_write(const std::filesystem::path& path, const std::string& format,
               const std::filesystem::path& file);

/// The files that reading `path` may read; "-" is what standard input is.
std::vector<std::filesystem::path> files_read(const std::filesystem::path& path,
                                              const std::string& format = {});

/// Are they one file, by whatever name and link?
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// What an output would overwrite: "part.node, a file of the input part.poly"; empty: nothing.
std::string overwritten(const std::vector<std::filesystem::path>& written,
                        const std::vector<std::string>& inputs, const std::string& input_format);

}  // namespace collarmesh::files
