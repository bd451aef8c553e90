#include "io/msh_sections.h"

#include <algorithm>
#include <cmath>

#include "common/is_finite.h"

namespace collarmesh::io {

namespace {

std::size_t count_lines(std::string_view text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

std::string_view line_at(std::string_view text, std::size_t at) {
  std::string_view line = text.substr(at, text.find('\n', at) - at);
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
  return line;
}

}  // namespace

std::vector<MshSection> split_msh(const std::string& path, std::string_view text) {
  std::vector<MshSection> sections;
  std::size_t at = 0, line = 1;
  for (;;) {
    const std::size_t start = text.find_first_not_of(" \t\r\n", at);
    if (start == std::string_view::npos) return sections;
    line += count_lines(text.substr(at, start - at));
    const auto fail = [&](const std::string& message) { TextScanner(path, {}, 0, line).fail(message); };
    const std::string_view head = line_at(text, start);
    if (head.size() < 2 || head[0] != '$')
      fail(fmt::format("expected a section such as $Nodes, found {}", in_quotes(head)));
    const std::size_t body = std::min(text.find('\n', start), text.size() - 1) + 1;
    const std::string end = fmt::format("$End{}", head.substr(1));
    const std::size_t stop = text.find(end, body);
    if (stop == std::string_view::npos)
      fail(fmt::format("the section {} has no {}; the file is cut off", in_quotes(head), in_quotes(end)));
    sections.push_back({head.substr(1), text.substr(body, stop - body), line + 1, body});
    at = stop + end.size();
    line += count_lines(text.substr(start, at - start));
  }
}

namespace {

std::string_view after_line(std::string_view text) {
  return text.substr(std::min(text.find('\n'), text.size() - 1) + 1);
}

}  // namespace

Point MshBytes::point(std::string_view what) {
  const double x = real(what), y = real(what), z = real(what);
  if (!is_finite({x, y, z}))
    fail(fmt::format("the point that ends here, ({}, {}, {}), is not finite", x, y, z));
  return {x, y, z};
}

MshBinary2::MshBinary2(const std::string& path, const MshSection& section, std::endian order)
    : MshBytes({path, after_line(section.body), order,
                section.first_byte + section.body.size() - after_line(section.body).size()}),
      count_(TextScanner(path, section.body, 0, section.first_line).integer("a count")) {}

Index MshBinary2::count(std::string_view what, std::size_t numbers) {
  if (count_ < 0 || static_cast<std::uint64_t>(count_) > bytes_.left() / (4 * numbers))
    fail(fmt::format("{} is {}, but only {} bytes follow; the file is cut off or wrong", what, count_,
                     bytes_.left()));
  return static_cast<Index>(count_);
}

}  // namespace collarmesh::io
