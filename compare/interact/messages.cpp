#include "compare/interact/messages.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace springproof::compare {

namespace {

std::optional<Eigen::Vector3d> vector_from(const nlohmann::json& message, const char* key) {
  constexpr double largest = 1e9; // mm
  const auto found = message.find(key);
  if (found == message.end() || !found->is_array() || found->size() != 3) return std::nullopt;
  Eigen::Vector3d vector;
  for (int axis = 0; axis < 3; ++axis) {
    const nlohmann::json& number = (*found)[static_cast<std::size_t>(axis)];
    if (!number.is_number()) return std::nullopt;
    vector[axis] = number.get<double>();
    if (!(std::abs(vector[axis]) <= largest)) return std::nullopt;
  }
  return vector;
}

} // namespace

std::optional<PageMessage> message_from(const std::string& text) {
  if (text.size() > longest_message) return std::nullopt;
  const nlohmann::json message =
      nlohmann::json::parse(text, nullptr, false); // no exceptions; nesting is bounded by the length
  if (!message.is_object()) return std::nullopt;
  const auto type = message.find("type");
  if (type == message.end() || !type->is_string()) return std::nullopt;
  const auto name = type->get<std::string>();
  const std::size_t n_keys = message.size();
  if (name == "frame" && n_keys == 1) return AskFrame{};
  if (name == "release" && n_keys == 1) return Release{};
  if (name == "restart" && n_keys == 1) return Restart{};
  if (name == "drag" && n_keys == 2)
    if (const auto by = vector_from(message, "by")) return Drag{*by};
  if (name == "grab" && n_keys == 3) {
    const auto origin = vector_from(message, "origin"), direction = vector_from(message, "direction");
    if (origin && direction && direction->norm() > 0) return Grab{{*origin, *direction}};
  }
  return std::nullopt;
}

} // namespace springproof::compare
