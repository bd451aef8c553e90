#include "io/msh_sections.h"

#include <algorithm>
#include <cmath>

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
      fail(fmt::format("expected a section such as $Nodes, found {}", quoted(head)));
    const std::size_t body = std::min(text.find('\n', start), text.size() - 1) + 1;
    const std::string end = fmt::format("$End{}", head.substr(1));
    const std::size_t stop = text.find(end, body);
    if (stop == std::string_view::npos)
      fail(fmt::format("the section {} has no {}; the file is cut off", quoted(head), end));
    sections.push_back({head.substr(1), text.substr(body, stop - body), line + 1, body});
    at = stop + end.size();
    line += count_lines(text.substr(start, at - start));
  }
}

Point MshBinary::point(std::string_view what) {
  const double x = real(what), y = real(what), z = real(what);
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z))
    fail(fmt::format("the point that ends here, ({}, {}, {}), is not finite", x, y, z));
  return {x, y, z};
}

}  // namespace collarmesh::io
