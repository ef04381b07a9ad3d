#pragma once

#include <string>
#include <toml++/toml.h>

namespace springproof::cases {

/// Puts one value of the command line into a case file's document: "fem.refine=1", "load[0].value=[0, 0,
/// 0.01]", "fem.element=q2". The value is TOML; what is not valid TOML is taken as a text, so that words need
/// no quotes. Tables that do not exist are made; elements of arrays must exist.
/// @throws InputError if it is not KEY=VALUE or leads through something that is no table
void apply_override(toml::table& document, const std::string& setting);

/// Whether a text is one line of UTF-8 without control characters, so that it can stand in messages and JSON.
bool is_line_of_text(const std::string& text);

} // namespace springproof::cases
