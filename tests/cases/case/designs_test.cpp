#include "cases/case/designs.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <set>
#include <sstream>

using namespace springproof;

using namespace cases;

TEST_CASE("every design has one row in the registry, at its own place") {
  REQUIRE(all_designs().size() == all_names<Design>().size());
  std::set<std::string> said;
  for (const std::string& name : all_names<Design>()) {
    const Design design = *value_of<Design>(name);
    CHECK(facts_of(design).design == design);
    CHECK_FALSE(std::string(facts_of(design).published_in).empty());
    CHECK(said.insert(facts_of(design).what).second); // no row copied and left as it was
  }
}

TEST_CASE("a key that only some designs take names them") {
  CHECK(takes(Design::given, "stiffness"));
  CHECK_FALSE(takes(Design::hybrid, "stiffness"));
  CHECK(designs_with("paths") == "\"multi_load\"");
  CHECK(designs_with("no_such_key").empty());
}

TEST_CASE("the documentation has every design and every key that only some take") {
  const auto text_of = [](const std::string& page) {
    std::ifstream file(SPRINGPROOF_SOURCE_DIR "/docs/" + page);
    REQUIRE(file);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  };
  const std::string designs = text_of("using/designs.md"), case_file = text_of("reference/case-file.md");
  for (const DesignFacts& facts : all_designs()) {
    const std::string name = name_of(facts.design);
    CAPTURE(name);
    CHECK(case_file.find("`\"" + name + "\"`") != std::string::npos);
    if (facts.source == DesignSource::material)
      CHECK(designs.find("| `" + name + "` |") != std::string::npos);
  }
  for (const std::string& key : keys_of_designs()) {
    CAPTURE(key);
    CHECK(case_file.find("| `" + key + "` |") != std::string::npos);
  }
}
