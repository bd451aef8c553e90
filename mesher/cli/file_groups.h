#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace collarmesh::cli {

/// The files that writing `path` makes: it and those that the format (its extension, or `format`) puts beside
/// it.
std::vector<std::filesystem::path> files_written(const std::filesystem::path& path,
                                                 const std::string& format = {});

/// The files that reading `path` may read; "-" is what standard input is.
std::vector<std::filesystem::path> files_read(const std::filesystem::path& path,
                                              const std::string& format = {});

/// Are they one file, by whatever name and link?
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// What an output would overwrite: "part.node, a file of the input part.poly"; empty: nothing.
std::string overwritten(const std::vector<std::filesystem::path>& written,
                        const std::vector<std::string>& inputs, const std::string& input_format);

}  // namespace collarmesh::cli
