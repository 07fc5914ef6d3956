// Foreign text inside XML.
#pragma once

#include <string>

namespace isoweave {

// As text between tags or in an attribute. Whatever is not ASCII becomes '?', as the encoding is not known.
std::string xml_text(const std::string& text);

// As text of a comment, which must not hold "--" nor end in '-'.
std::string xml_comment(const std::string& text);

}  // namespace isoweave
