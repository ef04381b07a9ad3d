#include "compare/interact/simulation.hpp"

#include "cases/mesh/vtk_functions.hpp"
#include "compare/table/table.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

using SteadyClock = std::chrono::steady_clock;
constexpr std::size_t most_messages = 1000; // between two steps
constexpr std::size_t most_times = 100'000;

/// The value that a part of the others does not exceed.
double value_below(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  const auto place = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[cases::index(place)];
}

double milliseconds(SteadyClock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

std::optional<Vector3d> vector_from(const nlohmann::json& message, const char* key) {
  constexpr double largest = 1e9; // mm
  const auto found = message.find(key);
  if (found == message.end() || !found->is_array() || found->size() != 3) return std::nullopt;
  Vector3d vector;
  for (int axis = 0; axis < 3; ++axis) {
    const nlohmann::json& number = (*found)[static_cast<std::size_t>(axis)];
    if (!number.is_number()) return std::nullopt;
    vector[axis] = number.get<double>();
    if (!(std::abs(vector[axis]) <= largest)) return std::nullopt;
  }
  return vector;
}

/// Adds a number for the page, little endian: its machine and the server's are one.
template<class To, class From>
void append(std::string& bytes, From value) {
  const To number = static_cast<To>(value);
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof number);
}

void append(std::string& bytes, const Eigen::Vector3d& vector) {
  for (int axis = 0; axis < 3; ++axis) append<float>(bytes, vector[axis]);
}

constexpr std::size_t coarse_triangles = 5000;

/// What the page draws of a body.
struct DrawnSurface {
  /// A surface, and, where it has more than coarse_triangles, the same in about so many, for pages whose
  /// pictures a processor draws. Each is 4 counts as uint32 (vertices, triangles, nodes that carry both
  /// surfaces, spheres), then as float32 the vertices at rest (3 each) and their weights (8 each), as uint32
  /// their nodes' places in `nodes` (8 each), the triangles (3 each) and the spheres' vertices; the coarse
  /// one has no spheres. Little endian.
  std::string bytes;
  std::vector<int> nodes; ///< the body's nodes that carry vertices
};

/// The surface in fewer triangles, or as it is where it is small or cannot be had in fewer.
cases::TriangleMesh few_triangles(const cases::TriangleMesh& fine) {
  if (fine.triangles.size() <= coarse_triangles) return fine;
  try {
    return cases::decimated(fine, coarse_triangles);
  } catch (const std::runtime_error&) {
    return fine;
  }
}

/// The surface in fewer triangles; none if there are no fewer, or a cell does not carry them: the page draws
/// all.
std::vector<mechanics::EmbeddedSurface> coarse_surface(const cases::TriangleMesh& fine,
                                                       const cases::Mesh& mesh) {
  const cases::TriangleMesh coarse = few_triangles(fine);
  if (coarse.triangles.size() == fine.triangles.size()) return {};
  try {
    return {mechanics::embed(coarse, mesh)};
  } catch (const std::runtime_error&) { // a cell is degenerate there
    return {};
  }
}

/// @param spheres  vertices of the surface, their centres    @param mesh  that the surface is bound to
DrawnSurface drawn_surface(const mechanics::EmbeddedSurface& surface, const std::vector<int>& spheres,
                           const cases::Mesh& mesh) {
  DrawnSurface drawn;
  std::vector<mechanics::EmbeddedSurface> surfaces = coarse_surface(surface.rest, mesh);
  surfaces.insert(surfaces.begin(), surface);
  std::vector<int> place(mesh.nodes.size(), -1);
  for (const auto& each : surfaces)
    for (const auto& vertex : each.vertices)
      for (const int node : vertex.nodes)
        if (int& here = place[cases::index(node)]; here < 0) {
          here = static_cast<int>(drawn.nodes.size());
          drawn.nodes.push_back(node);
        }
  for (const auto& each : surfaces) {
    const bool has_spheres = &each == &surfaces.front();
    for (const std::size_t count : {each.vertices.size(), each.rest.triangles.size(), drawn.nodes.size(),
                                    has_spheres ? spheres.size() : 0})
      append<std::uint32_t>(drawn.bytes, count);
    for (const Eigen::Vector3d& vertex : each.rest.vertices) append(drawn.bytes, vertex);
    for (const auto& vertex : each.vertices)
      for (const double weight : vertex.weights) append<float>(drawn.bytes, weight);
    for (const auto& vertex : each.vertices)
      for (const int node : vertex.nodes) append<std::uint32_t>(drawn.bytes, place[cases::index(node)]);
    for (const auto& triangle : each.rest.triangles)
      for (const int vertex : triangle) append<std::uint32_t>(drawn.bytes, vertex);
    if (!has_spheres) continue;
    for (const int vertex : spheres) append<std::uint32_t>(drawn.bytes, vertex);
  }
  return drawn;
}

/// What the page draws of a tool.
nlohmann::ordered_json described(const cases::Tool& tool) {
  nlohmann::ordered_json all{{"name", tool.name}};
  std::visit(
      [&](const auto& shape) {
        using Shape = std::decay_t<decltype(shape)>;
        using namespace cases::tools;
        const auto numbers = [](const Vector3d& of) { return std::vector<double>(of.begin(), of.end()); };
        all["shape"] = Shape::name;
        if constexpr (std::is_same_v<Shape, Surface>) {
          const cases::TriangleMesh drawn = few_triangles({shape.vertices, shape.triangles});
          for (const Vector3d& vertex : drawn.vertices)
            for (const double x : vertex) all["vertices"].push_back(static_cast<float>(x));
          for (const auto& triangle : drawn.triangles)
            for (const int vertex : triangle) all["triangles"].push_back(vertex);
        } else if constexpr (!std::is_same_v<Shape, Plane>) {
          all["radius"] = shape.radius;
        }
        if constexpr (std::is_same_v<Shape, Plane>) all["axis"] = numbers(shape.normal);
        if constexpr (std::is_same_v<Shape, Cylinder> || std::is_same_v<Shape, Punch>)
          all["axis"] = numbers(shape.axis);
      },
      tool.shape);
  return all;
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
  if (name == "grab_tool" && n_keys == 2)
    if (const auto tool = message.find("tool"); tool != message.end() && tool->is_number_unsigned())
      return GrabTool{tool->get<std::size_t>()};
  if (name == "grab" && n_keys == 3) {
    const auto origin = vector_from(message, "origin"), direction = vector_from(message, "direction");
    if (origin && direction && direction->norm() > 0) return Grab{{*origin, *direction}};
  }
  return std::nullopt;
}

Simulation::Simulation(const cases::Scene& scene, const PullSettings& settings,
                       std::function<void(std::shared_ptr<const std::string>)> on_frame)
    : scene_(scene), body_(scene, settings), on_frame_(std::move(on_frame)) {
  const mechanics::EmbeddedSurface& surface = body_.surface();
  DrawnSurface drawn = drawn_surface(surface, body_.spheres().vertices, scene_.mesh);
  geometry_ = std::move(drawn.bytes);
  carrying_ = std::move(drawn.nodes);
  auto tools = nlohmann::ordered_json::array();
  for (const cases::Tool& tool : scene_.definition.tools) tools.push_back(described(tool));
  description_ = nlohmann::ordered_json{
      {"name", scene_.definition.name},
      {"description", scene_.definition.description},
      {"masses", scene_.mesh.nodes.size()},
      {"cells", scene_.mesh.cells.size()},
      {"unknowns", body_.n_unknowns()},
      {"method", body_.method_text()},
      {"step_s", scene_.definition.dynamics->step},
      {"triangles", surface.rest.triangles.size()},
      {"spheres", body_.spheres().vertices.size()},
      {"radius", body_.spheres().radius},
      {"tools",
       tools}}.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
  thread_ = std::thread([this] { run(); });
}

Simulation::~Simulation() {
  stop();
}

void Simulation::start() {
  const std::lock_guard lock(mutex_);
  is_running_ = true;
  wake_.notify_one();
}

void Simulation::pause() {
  const std::lock_guard lock(mutex_);
  is_running_ = is_frame_asked_for_ = false;
  messages_ = {Release{}};
}

void Simulation::send(const PageMessage& message) {
  const std::lock_guard lock(mutex_);
  if (std::holds_alternative<AskFrame>(message)) {
    is_frame_asked_for_ = true;
    return;
  }
  if (std::holds_alternative<Drag>(message)) ++n_drags_;
  const bool replaces =
      !messages_.empty() && messages_.back().index() == message.index(); // the last one of a kind counts
  if (replaces)
    messages_.back() = message;
  else if (messages_.size() < most_messages)
    messages_.push_back(message);
}

void Simulation::stop() {
  {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
    wake_.notify_one();
  }
  if (thread_.joinable()) thread_.join();
}

void Simulation::run() {
  const auto length = std::chrono::duration_cast<SteadyClock::duration>(
      std::chrono::duration<double>(scene_.definition.dynamics->step));
  constexpr auto most_behind =
      std::chrono::milliseconds(250); // what is slower than that is not caught up with
  auto due = SteadyClock::now(), second = due;
  long steps_at_second = 0;
  for (std::vector<PageMessage> messages;;) {
    {
      std::unique_lock lock(mutex_);
      const bool was_running = is_running_;
      wake_.wait(lock, [&] { return is_running_ || is_stopped_; });
      if (!was_running) due = second = SteadyClock::now(), steps_at_second = summary_.n_steps;
      if (is_stopped_) return;
      messages.swap(messages_);
      messages_.clear();
      n_drags_taken_ = n_drags_;
    }
    take(messages);
    messages.clear();
    step();
    const auto now = SteadyClock::now();
    if (now - second >= std::chrono::seconds(1)) {
      steps_per_second_ =
          1000 * static_cast<double>(summary_.n_steps - steps_at_second) / milliseconds(now - second);
      second = now;
      steps_at_second = summary_.n_steps;
    }
    bool is_asked = false;
    {
      const std::lock_guard lock(mutex_);
      is_asked = std::exchange(is_frame_asked_for_, false);
    }
    if (is_asked) on_frame_(frame());
    due += length;
    if (SteadyClock::now() - due > most_behind) due = SteadyClock::now();
    std::unique_lock lock(mutex_);
    wake_.wait_until(lock, due, [&] { return is_stopped_; });
  }
}

void Simulation::take(const std::vector<PageMessage>& messages) {
  for (const PageMessage& message : messages) {
    if (const auto* grab = std::get_if<Grab>(&message)) body_.grab(grab->ray);
    if (const auto* grab = std::get_if<GrabTool>(&message)) body_.grab_tool(grab->tool);
    if (const auto* drag = std::get_if<Drag>(&message)) body_.drag(drag->by);
    if (std::holds_alternative<Release>(message)) body_.release();
    if (std::holds_alternative<Restart>(message)) body_.restart();
  }
}

void Simulation::step() {
  const auto held_tool = body_.held_tool();
  const Vector3d tool_before = held_tool ? body_.tools()[*held_tool].at : Vector3d::Zero();
  const auto before = SteadyClock::now();
  body_.step();
  const double taken = milliseconds(SteadyClock::now() - before);
  step_ms_.push_back(taken);
  if (step_ms_.size() > most_times) step_ms_.pop_front();
  summary_.largest_ms = std::max(summary_.largest_ms, taken);
  ++summary_.n_steps;
  if (body_.n_steps() <= last_step_) { // recordings hold the motion since its last start
    recording_.clear();
    tool_recording_.clear();
  }
  last_step_ = body_.n_steps();
  if (held_tool && last_step_ > 0) record_tool(*held_tool, tool_before);
  double tool_force = 0;
  for (const auto& [at, contact] : body_.tools()) tool_force = std::max(tool_force, contact.force.norm());
  summary_.n_pressed += tool_force > 0;
  summary_.largest_tool_force = std::max(summary_.largest_tool_force, tool_force);
  if (const auto held = body_.held(); held && !body_.force().isZero(0)) {
    ++summary_.n_pulled;
    if (recording_.size() < most_recorded) recording_.push_back({body_.n_steps(), *held, body_.force()});
  }
}

/// Between a tool's rows it goes straight: where it begins to move it has one for the step before.
void Simulation::record_tool(std::size_t tool, const Vector3d& before) {
  const Vector3d& now = body_.tools()[tool].at;
  if (now == before || tool_recording_.size() + 2 > most_recorded) return;
  const auto is_of_tool = [&](const RecordedTool& row) { return row.tool == tool; };
  const auto last = std::find_if(tool_recording_.rbegin(), tool_recording_.rend(), is_of_tool);
  if (last == tool_recording_.rend() || last->step < last_step_ - 1)
    tool_recording_.push_back({last_step_ - 1, tool, before});
  tool_recording_.push_back({last_step_, tool, now});
}

std::shared_ptr<const std::string> Simulation::frame() {
  constexpr std::size_t shown = 500; // number of last steps whose median and 99th percentile are shown
  const auto n = static_cast<std::ptrdiff_t>(std::min(shown, step_ms_.size()));
  const std::vector<double> last(step_ms_.end() - n, step_ms_.end());
  const int n_inverted = body_.n_inverted();
  if (n_inverted > 0) ++summary_.n_inverted_frames;
  auto bytes = std::make_shared<std::string>();
  const std::array<double, frame_numbers> numbers{body_.time(),
                                                  static_cast<double>(summary_.n_steps),
                                                  value_below(last, 0.5),
                                                  value_below(last, 0.99),
                                                  steps_per_second_,
                                                  static_cast<double>(n_inverted),
                                                  static_cast<double>(body_.held().value_or(-1)),
                                                  body_.force().norm(),
                                                  static_cast<double>(body_.troubles().n_failures),
                                                  static_cast<double>(n_drags_taken_),
                                                  body_.residual(),
                                                  static_cast<double>(carrying_.size())};
  bytes->reserve(8 * frame_numbers + 12 * carrying_.size() + 24 * body_.tools().size());
  for (const double number : numbers) append<double>(*bytes, number);
  const MovedBody::Points& displacement = body_.displacement();
  for (const int node : carrying_) append(*bytes, displacement[cases::index(node)]);
  for (const auto& [at, contact] : body_.tools()) {
    append(*bytes, at);
    append(*bytes, contact.force);
  }
  ++summary_.n_frames;
  return bytes;
}

void Simulation::write_recording(std::ostream& out) const {
  CsvWriter csv(out, 17); // doubles come back as they were
  out << recording_header << '\n';
  for (const RecordedPull& pull : recording_) {
    const Vector3d& place = body_.surface().rest.vertices[cases::index(pull.vertex)];
    const double time = static_cast<double>(pull.step) * scene_.definition.dynamics->step;
    csv.row(pull.step, time, place.x(), place.y(), place.z(), body_.spheres().radius, pull.force.x(),
            pull.force.y(), pull.force.z());
  }
}

void Simulation::write_tool_recording(std::ostream& out) const {
  CsvWriter csv(out, 17); // doubles come back as they were
  out << tool_recording_header << '\n';
  for (const auto& [step, tool, at] : tool_recording_)
    csv.row(step, static_cast<double>(step) * scene_.definition.dynamics->step, tool, at.x(), at.y(), at.z());
}

SimulationSummary Simulation::summary() const {
  SimulationSummary summary = summary_;
  const std::vector<double> times(step_ms_.begin(), step_ms_.end());
  summary.median_ms = value_below(times, 0.5);
  summary.p99_ms = value_below(times, 0.99);
  summary.method = body_.method_text();
  summary.troubles = body_.troubles();
  return summary;
}

} // namespace springproof::compare
