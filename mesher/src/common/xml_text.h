#pragma once

#include <string>
#include <string_view>

namespace collarmesh {

/// Escapes a text for use between tags, or between the quotes of an attribute, of XML and HTML.
inline std::string xml_text(std::string_view text) {
  std::string result;
  for (const char c : text) switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      default: result += c;
    }
  return result;
}

}  // namespace collarmesh
