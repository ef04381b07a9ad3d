#pragma once

#include "compare/interact/pulled_body.hpp"
#include "compare/interact/recording.hpp"
#include "compare/study/study.hpp"

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <variant>

namespace springproof::compare {

/// What the page of `springproof interact` says to its server.
struct AskFrame {}; ///< the page has drawn the last frame and takes another
struct Grab {
  mechanics::Ray ray;
};
struct GrabTool {
  std::size_t tool; ///< its number in the case
};
struct Drag {
  Eigen::Vector3d by; ///< mm, from where the place or the tool was when it was grabbed
};
struct Release {};
struct Restart {};
using PageMessage = std::variant<AskFrame, Grab, GrabTool, Drag, Release, Restart>;

/// The longest text that is a message, bytes.
constexpr std::size_t longest_message = 512;

/// The message in {"type": "frame" | "grab" | "grab_tool" | "drag" | "release" | "restart"}; a grab has
/// "origin" and "direction", a drag has "by", each of three finite numbers up to 1e9, the direction not 0,
/// and a grab_tool has "tool", a whole number from 0; and there are no other keys.
/// @return nothing where the text is anything else
std::optional<PageMessage> message_from(const std::string& text);

/// A force of a recording: of one step on one place.
struct RecordedPull {
  long step;             ///< its number since the start of the motion: the force acts in it, up to its end
  int vertex;            ///< number in the surface
  Eigen::Vector3d force; ///< N
};

/// Where a tool was at the end of a step in which a hand had it, or before it.
struct RecordedTool {
  long step;
  std::size_t tool;
  Eigen::Vector3d at; ///< mm
};

struct SimulationSummary {
  std::string method;                           ///< PulledBody::method_text()
  long n_steps = 0, n_frames = 0, n_pulled = 0; ///< steps in all, frames made, steps with a pull
  long n_pressed = 0;                           ///< steps at whose end a tool presses
  double largest_tool_force = 0;                ///< N
  StepTroubles troubles;
  long n_inverted_frames = 0;                       ///< frames that showed inverted cells
  double median_ms = 0, p99_ms = 0, largest_ms = 0; ///< wall clock of the last 100,000 steps

  /// Whether 99 % of its steps do; nothing where there was none.
  std::optional<bool> keeps_60_hz() const {
    return n_steps > 0 ? std::optional(p99_ms <= milliseconds_a_picture) : std::nullopt;
  }
};

/// A body's motion in a thread of its own, in real time where a step takes less than its own length. It never
/// waits for who looks at it: a frame is made after a step when one was asked for since the last frame.
class Simulation {
 public:
  /// @param on_frame  called from the simulation's thread; must not block
  Simulation(const cases::Scene& scene, const PullSettings& settings,
             std::function<void(std::shared_ptr<const std::string>)> on_frame);
  ~Simulation();

  /// May be called from any thread. Nothing moves before the first start().
  void start();
  void pause(); ///< and releases what is held
  void send(const PageMessage& message);
  void stop(); ///< joins the thread

  /// {"name", "description", "masses", "cells", "unknowns", "method", "step_s", "triangles", "spheres",
  /// "radius", "tools": [{"name", "shape", "radius", "axis", "vertices", "triangles"}]}; an axis is a
  /// cylinder's or a punch's, or a plane's normal; vertices (mm, from its place) and triangles are a
  /// surface's, one after the other
  const std::string& description() const { return description_; }
  /// What the page draws: see DrawnSurface in simulation.cpp, whose nodes are in the order of a frame.
  const std::string& geometry() const { return geometry_; }

  /// Summary of the motion, after stop(). A recording is of the motion since its last start.
  SimulationSummary summary() const;
  bool has_recording() const { return !recording_.empty(); }
  bool is_recording_full() const {
    return recording_.size() >= most_recorded || tool_recording_.size() + 2 > most_recorded;
  }
  /// Writes what read_recording() reads.
  void write_recording(std::ostream& out) const;
  bool has_tool_recording() const { return !tool_recording_.empty(); }
  /// Writes what read_tool_recording() reads.
  void write_tool_recording(std::ostream& out) const;

  static constexpr std::size_t frame_numbers = 12; ///< float64 at the beginning of a frame

 private:
  const cases::Scene& scene_;
  PulledBody body_;
  std::function<void(std::shared_ptr<const std::string>)> on_frame_;
  std::string description_, geometry_;
  std::vector<int> carrying_; ///< nodes, in the order of a frame

  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<PageMessage> messages_; ///< since the last step; at most one Drag in a row
  bool is_running_ = false, is_stopped_ = false;
  bool is_frame_asked_for_ = false;
  long n_drags_ = 0; ///< that were sent, those that later ones replaced too
  std::thread thread_;

  long n_drags_taken_ = 0;     ///< before the last step
  std::deque<double> step_ms_; ///< the last steps
  SimulationSummary summary_;
  std::vector<RecordedPull> recording_;
  std::vector<RecordedTool> tool_recording_;
  double steps_per_second_ = 0;
  long last_step_ = 0; ///< step of the motion since its last start

  void run();
  void take(const std::vector<PageMessage>& messages);
  void step();
  void record_tool(std::size_t tool, const Eigen::Vector3d& before);
  /// Numbers, the displacement of the carrying nodes (3 float32 each), and of each tool where it is (mm) and
  /// its force (N), 6 float32.
  std::shared_ptr<const std::string> frame();
};

} // namespace springproof::compare
