// Foreign text inside XML.
#pragma once

#include <string>

namespace isoweave {

// Text between tags or in an attribute. A character that is not ASCII becomes '?', as the encoding is not known.
std::string xml_text(const std::string& text);

// Text of a comment, which must not hold "--" nor end in '-'.
std::string xml_comment(const std::string& text);

}  // namespace isoweave
