#include "html_report.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "console.h"
#include "html_report_page.h"

namespace collarmesh::cli {

namespace {

using Json = nlohmann::ordered_json;

template <class Number>
void append(std::string& bytes, const std::vector<Number>& numbers) {
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
}

std::string compressed(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  const int status =
      compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), Z_DEFAULT_COMPRESSION);
  if (status != Z_OK) throw std::runtime_error("the mesh cannot be compressed for the report");
  packed.resize(size);
  return packed;
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// Nothing in it ends the script that it is in.
std::string json_in_page(const Json& json) {
  std::string text = json_text(json), safe;
  safe.reserve(text.size());
  for (const char c : text) c == '<' ? safe += "\\u003c" : safe += c;
  return safe;
}

Json shown_json(const ShownMesh& shown) {
  const auto place = [](const Point& p) { return Json::array({p.x, p.y, p.z}); };
  Json worst = Json::array();
  for (const ShownMesh::WorstTet& w : shown.worst)
    worst.push_back(
        {{"tet", w.tet}, {"smallest", w.smallest}, {"largest", w.largest}, {"where", place(w.where)}});
  return {{"complete", shown.complete},
          {"centre", place(shown.centre)},
          {"points", shown.points.size() / 3},
          {"tets", shown.tets.size() / 4},
          {"worst", std::move(worst)}};
}

}  // namespace

std::string html_report(const Json& report, const ShownMesh& shown) {
  std::string data;
  append(data, shown.points);
  append(data, shown.tets);
  append(data, shown.region);
  append(data, shown.marks);
  std::string page;
  std::string_view rest = html_report_page;
  const auto fill = [&](std::string_view mark, const std::string& text) {
    const std::size_t at = rest.find(mark);
    page += rest.substr(0, at);
    page += text;
    rest.remove_prefix(at + mark.size());
  };
  fill("<!--report-->", json_in_page(report));
  fill("<!--shown-->", json_in_page(shown_json(shown)));
  fill("<!--data-->", base64(compressed(data)));
  return page.append(rest);
}

bool is_html(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".html" || extension == ".htm";
}

}  // namespace collarmesh::cli
