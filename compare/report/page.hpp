#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

/// The one builder of pages: a page is page.html with its data, which its scripts render.
namespace springproof::compare {

/// A script that pages are made with: three.min.js, OrbitControls.js, chart.min.js.
std::string page_script(const std::string& name);

/// page.html of a data folder, every {{name}} replaced by its value or else by the file of that name there.
std::string filled_page(const std::string& data, const std::map<std::string, std::string>& values);

/// JSON as it may stand in a <script>: no text of it can end the element or begin a comment.
std::string embedded(const nlohmann::ordered_json& document);

/// A drawn figure of a folder (NAME.svg) as an element of the page, which is shown where scripts are off and
/// taken to its place by the page's script elsewhere.
std::string picture(const std::string& folder, const std::string& name, const std::string& caption);

/// Writes a page that needs no other file and no network, whole or not at all.
/// @param title     of the browser's window
/// @param data      what the sections of page.js are made from: "heading" and "subheading", "times" ({phase,
///                  seconds}), and what each section reads; one without data is left out. Versions and
///                  licences are added here.
/// @param pictures  of picture(), one after the other
/// @throws InputError if something cannot be read or written
void write_page(const std::string& file, const std::string& title, nlohmann::ordered_json data,
                const std::string& pictures = "");

} // namespace springproof::compare
