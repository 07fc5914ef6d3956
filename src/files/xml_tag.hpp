// Attributes of one XML tag.
#pragma once

#include <string>
#include <string_view>

namespace isoweave {

// The value of attribute `name` in "<Tag name="value" ...>", with entities replaced; empty when it is not there.
std::string xml_attribute(std::string_view tag, std::string_view name);

}  // namespace isoweave
