#include "apps/manual/roff.h"

#include <fmt/format.h>

#include <cctype>
#include <sstream>

namespace gatelight::apps {
namespace {

bool is_lower(char c) {
  return c >= 'a' && c <= 'z';
}
bool is_upper(char c) {
  return c >= 'A' && c <= 'Z';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string bold(std::string_view text) {
  return fmt::format("\\fB{}\\fR", roff_escaped(text));
}

/// Length of the flag at the beginning of a text, "--spp" or "-o"; 0: there is none.
std::size_t flag_length(std::string_view text) {
  if (!text.starts_with('-')) return 0;
  const std::size_t dashes = text.starts_with("--") ? 2 : 1;
  std::size_t end = dashes;
  while (end < text.size() && (is_lower(text[end]) || is_digit(text[end]) || text[end] == '-')) ++end;
  const bool is_letter = dashes == 1 && end == 2;
  return end > dashes && is_lower(text[dashes]) && (dashes == 2 || is_letter) ? end : 0;
}

/// A line that begins with a point or an apostrophe would be a request.
std::string line_of(std::string line) {
  const bool is_request = line.starts_with('.') || line.starts_with('\'');
  line.resize(line.find_last_not_of(' ') + 1);
  return fmt::format("{}{}\n", is_request ? "\\&" : "", line);
}

std::string_view without_indent(std::string_view line) {
  return line.substr(std::min(line.find_first_not_of(' '), line.size()));
}

}  // namespace

std::string roff_escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '\\':
        escaped += "\\e";
        break;
      case '-':
        escaped += "\\-";
        break;
      case '\'':
        escaped += "\\(aq";
        break;
      case '`':
        escaped += "\\(ga";
        break;
      case '^':
        escaped += "\\(ha";
        break;
      case '~':
        escaped += "\\(ti";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string roff_prose(std::string_view text) {
  std::string prose;
  char before = ' ';
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view rest = text.substr(at);
    const bool is_begin = !std::isalnum(static_cast<unsigned char>(before)) && before != '-';
    std::size_t length = is_begin ? flag_length(rest) : 0;
    if (length > 0) {
      prose += bold(rest.substr(0, length));
    } else if (const std::size_t end = rest.starts_with('`') ? rest.find('`', 1) : std::string_view::npos;
               end != std::string_view::npos) {
      prose += bold(rest.substr(1, end - 1));
      length = end + 1;
    } else {
      prose += roff_escaped(rest.substr(0, 1));
      length = 1;
    }
    before = rest[length - 1];
    at += length;
  }
  return line_of(prose);
}

std::string roff_placeholder(std::string_view unit) {
  std::string text;
  for (std::size_t at = 0; at < unit.size();) {
    std::size_t end = at;
    while (end < unit.size() && (is_upper(unit[end]) || (end > at && is_digit(unit[end])))) ++end;
    const bool is_name = end > at;
    if (!is_name) ++end;
    const std::string part = roff_escaped(unit.substr(at, end - at));
    text += is_name ? fmt::format("\\fI{}\\fR", part) : part;
    at = end;
  }
  return text;
}

std::string roff_paragraphs(std::string_view text) {
  enum class In { none, paragraph, item };
  In in = In::none;
  std::string source;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    const std::string_view words = without_indent(line);
    const std::size_t indent = line.size() - words.size();
    if (words.empty()) {
      in = In::none;
    } else if (indent == 2) {
      const std::size_t gap = std::min(words.find("  "), words.size());
      source += ".TP\n" + line_of(bold(words.substr(0, gap)));
      source += roff_prose(without_indent(words.substr(gap)));
      in = In::item;
    } else {
      const bool goes_on = in == In::paragraph || (in == In::item && indent > 2);
      if (!goes_on) {
        if (!source.empty()) source += ".PP\n";
        in = In::paragraph;
      }
      source += roff_prose(words);
    }
  }
  return source;
}

std::string roff_code(std::string_view text) {
  std::string source = ".EX\n";
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) source += line_of(roff_escaped(without_indent(line)));
  return source + ".EE\n";
}

}  // namespace gatelight::apps
