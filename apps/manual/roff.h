#pragma once
// Plain text as the source of a manual page: roff with the macros of man(7).

#include <string>
#include <string_view>

namespace gatelight::apps {

/// The characters of the text, without a meaning for roff.
std::string roff_escaped(std::string_view text);

/// A line of prose: flags, and words in back-ticks, are bold.
std::string roff_prose(std::string_view text);

/// A placeholder of a value: names in capitals are italic.
std::string roff_placeholder(std::string_view unit);

/// The description in the footer of a help: paragraphs, and items of lines such as "  NAME   text".
std::string roff_paragraphs(std::string_view text);

/// Lines as they stand, as a block of code.
std::string roff_code(std::string_view lines);

}  // namespace gatelight::apps
