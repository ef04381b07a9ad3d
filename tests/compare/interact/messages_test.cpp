#include "compare/interact/simulation.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace compare;

TEST_CASE("what a page may say is read, and nothing else is") {
  CHECK(std::holds_alternative<AskFrame>(message_from(R"({"type": "frame"})").value()));
  CHECK(std::holds_alternative<Release>(message_from(R"({"type":"release"})").value()));
  CHECK(std::holds_alternative<Restart>(message_from(R"({"type":"restart"})").value()));
  const auto drag = message_from(R"({"type": "drag", "by": [1, -2.5, 3e2]})");
  CHECK(std::get<Drag>(drag.value()).by == Eigen::Vector3d(1, -2.5, 300));
  const auto grab = message_from(R"({"direction": [0, 0, -1], "origin": [4, 5, 6], "type": "grab"})");
  CHECK(std::get<Grab>(grab.value()).ray.origin == Eigen::Vector3d(4, 5, 6));
  for (const std::string text :
       {"", "frame", "[]", "null", R"({"type": "frame")", R"({"type": "frame", "x": 0})", R"({"type": 3})",
        R"({"type": "halt"})", R"({"type": "drag"})", R"({"type": "drag", "by": [1, 2]})",
        R"({"type": "drag", "by": [1, 2, 3, 4]})", R"({"type": "drag", "by": [1, 2, null]})",
        R"({"type": "drag", "by": [1, 2, "3"]})", R"({"type": "drag", "by": [1, 2, 1e10]})",
        R"({"type": "drag", "by": [1, 2, 1e400]})", R"({"type": "drag", "by": [1, 2, NaN]})",
        R"({"type": "grab", "origin": [0, 0, 0], "direction": [0, 0, 0]})",
        R"({"type": "grab", "origin": [0, 0, 0]})", R"({"type": "frame"} {"type": "frame"})"}) {
    CAPTURE(text);
    CHECK_FALSE(message_from(text));
  }
  CHECK_FALSE(message_from(std::string(longest_message, ' ') + R"({"type": "frame"})"));
  CHECK_FALSE(message_from(std::string(500, '[')));
}
