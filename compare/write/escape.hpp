#pragma once

#include <string>

namespace springproof::compare {

/// Text as it may stand between the tags of HTML and XML and inside an attribute, in either kind of quotes.
std::string escape(const std::string& text);

} // namespace springproof::compare
