#include "compare/client/ask_client.hpp"

#include "cases/case/error.hpp"
#include "compare/peers/motion.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/solve/solve.hpp"
#include "compare/table/json.hpp"
#include "msm/problem.hpp"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

using Displacement = std::vector<Eigen::Vector3d>;

constexpr std::size_t most_line = 100'000; ///< bytes
constexpr double most_sizes = 1000;        ///< sizes of the body, that a node may move by

[[noreturn]] void refuse_answer(const std::string& problem) {
  throw cases::SolveError(problem);
}

/// A line that must be an object of JSON.
Json object_of(const std::string& line, const std::string& stage) {
  const Json object = Json::parse(line, nullptr, false);
  if (object.is_object()) return object;
  refuse_answer(
      fmt::format("{}: a line that is no JSON object: \"{}\"; standard output is for the protocol alone, "
                  "print to standard error",
                  stage, one_line(line.substr(0, 80))));
}

std::string text_at(const Json& object, const char* key, const std::string& stage) {
  if (object.contains(key) && object[key].is_string())
    return one_line(object[key].get<std::string>().substr(0, 200));
  refuse_answer(fmt::format("{}: \"{}\" is missing or no text", stage, key));
}

double number_at(const Json& object, const char* key, const std::string& stage) {
  if (object.contains(key) && object[key].is_number()) {
    const double value = object[key].get<double>();
    if (std::isfinite(value) && value >= 0) return value;
  }
  refuse_answer(fmt::format("{}: \"{}\" is missing or no number from 0 on", stage, key));
}

Introduction introduction_of(const Json& hello) {
  const std::string stage = "its introduction";
  if (hello.contains("error")) refuse_answer("it gave up: " + text_at(hello, "error", stage));
  const double protocol = number_at(hello, "protocol", stage);
  if (protocol != client_protocol)
    refuse_answer(fmt::format("{}: protocol is {:g}, must be {}", stage, protocol, client_protocol));
  Introduction client{text_at(hello, "name", stage),
                      text_at(hello, "version", stage),
                      text_at(hello, "method", stage),
                      hello.value("settings", Json::object()).dump().substr(0, 1000),
                      {}};
  if (!hello.contains("unsupported") || !hello["unsupported"].is_array())
    refuse_answer(stage + ": \"unsupported\" is missing or no list; it is [] if the client ignores nothing");
  for (const Json& ignored : hello["unsupported"]) {
    if (!ignored.is_string()) refuse_answer(stage + ": \"unsupported\" has an entry that is no text");
    client.unsupported.push_back(one_line(ignored.get<std::string>().substr(0, 200)));
  }
  return client;
}

/// A conversation with a client, one frame after the other.
class Session {
 public:
  Session(const cases::Scene& scene, const Client& client, const ClientBudget& budget, ClientAnswer& found)
      : scene_(scene), budget_(budget), found_(found),
        size_(cases::bounding_box(scene.mesh.nodes).diagonal().norm()),
        program_(client.words, {budget.start_seconds + budget.seconds}) {}

  void introduce(const std::string& message) {
    program_.write(message, budget_.start_seconds, "reading the scene");
    found_.introduction = introduction_of(object_of(
        program_.read_line(most_line, budget_.start_seconds, "introducing itself"), "its introduction"));
  }

  /// @param number  of the frame, from 0 on    @param time  it must be of, s; absent: any
  Displacement frame(std::size_t number, std::optional<double> time) {
    const std::string stage = fmt::format("frame {}", number);
    const Json header = object_of(program_.read_line(most_line, budget_.seconds, stage), stage);
    if (header.contains("error")) refuse_answer("it gave up: " + text_at(header, "error", stage));
    if (number_at(header, "frame", stage) != double(number))
      refuse_answer(
          fmt::format("{}: \"frame\" is {:g}, must be {}", stage, number_at(header, "frame", stage), number));
    found_.model_time = number_at(header, "time", stage);
    if (time && !(std::abs(found_.model_time - *time) <= 1e-6 * std::max(*time, 1e-3)))
      refuse_answer(fmt::format("{}: \"time\" is {:g} s, must be {:g} s", stage, found_.model_time, *time));
    found_.stepping_seconds = number_at(header, "seconds", stage);
    found_.n_steps = static_cast<int>(std::min(number_at(header, "steps", stage), 1e9));
    if (!time) {
      if (!header.contains("at_rest") || !header["at_rest"].is_boolean())
        refuse_answer(stage + ": \"at_rest\" is missing, must be true or false");
      found_.is_at_rest = header["at_rest"].get<bool>();
      if (header.contains("mean_from")) found_.mean_from = number_at(header, "mean_from", stage);
    }
    const std::string has = text_at(header, "has", stage);
    if (has != "positions" && has != "displacements")
      refuse_answer(fmt::format("{}: \"has\" is \"{}\", must be positions or displacements", stage, has));
    const double n = number_at(header, "nodes", stage);
    if (n != double(scene_.mesh.nodes.size()))
      refuse_answer(fmt::format("{}: {:g} nodes, the scene has {}", stage, n, scene_.mesh.nodes.size()));
    return values(stage, has == "positions");
  }

  void end(std::size_t n_frames) {
    const std::string stage = fmt::format("after {} frame{}", n_frames, n_frames == 1 ? "" : "s");
    const Json header = object_of(program_.read_line(most_line, budget_.seconds, stage), stage);
    if (!header.contains("end")) refuse_answer(stage + ": it goes on; {\"end\": true} must follow");
  }

 private:
  const cases::Scene& scene_;
  const ClientBudget& budget_;
  ClientAnswer& found_;
  double size_; ///< the body's, mm
  ConfinedProgram program_;

  /// The frame's numbers as displacements, mm.
  Displacement values(const std::string& stage, bool are_positions) {
    const std::size_t n = scene_.mesh.nodes.size();
    const std::string bytes = program_.read_bytes(3 * n * sizeof(double), budget_.seconds, stage);
    Displacement all(n);
    for (std::size_t i = 0; i < n; ++i) {
      std::memcpy(all[i].data(), bytes.data() + 3 * i * sizeof(double), 3 * sizeof(double));
      all[i] *= 1e3;
      if (!all[i].allFinite()) refuse_answer(fmt::format("{}: node {} is at no finite place", stage, i));
      if (are_positions) all[i] -= scene_.mesh.nodes[i];
      if (!(all[i].norm() <= most_sizes * size_))
        refuse_answer(fmt::format("{}: node {} has moved by more than {:g} times the body's size: the answer "
                                  "has diverged",
                                  stage, i, most_sizes));
    }
    return all;
  }
};

void take_answer(Session& session, const cases::Scene& scene, ClientAnswer& found) {
  cases::Solution& solution = found.answer.solution;
  if (scene.definition.dynamics) {
    record_motion(scene, solution, [&](std::size_t k, double time) { return session.frame(k, time); });
    session.end(frame_times(scene).size());
  } else {
    solution.displacement = session.frame(0, std::nullopt);
    session.end(1);
  }
  HeldAgainstCase held = hold_against_case(scene, solution.displacement);
  solution.message = held.message;
  found.warnings = std::move(held.warnings);
  solution.status = cases::Status::converged;
  solution.load_reached = 1;
  msm::measure_cells(scene.mesh, solution);
  if (!found.is_at_rest) found.warnings.push_back(describe_moving(found.model_time, found.mean_from));
}

} // namespace

std::string describe_moving(double time, std::optional<double> mean_from) {
  return fmt::format("still moves after {:g} s{}", time,
                     mean_from ? fmt::format("; these are its mean places from {:g} s on", *mean_from) : "");
}

Client client_of(const std::string& argument) {
  const std::size_t at = argument.find('=');
  if (at == std::string::npos || at == 0)
    throw cases::InputError(fmt::format(
        "--client: \"{}\" is not NAME=COMMAND; give a name and a command, such as mine='python3 mine.py'",
        argument));
  Client client{argument.substr(0, at), words_of_command(argument.substr(at + 1))};
  for (std::string& word : client.words) // a client runs in a folder of its own
    if (word.find('/') != std::string::npos && std::filesystem::exists(word))
      word = std::filesystem::absolute(word).lexically_normal().string();
  return client;
}

ClientAnswer ask_client(const cases::Scene& scene, const Client& client, const ClientBudget& budget) {
  ClientAnswer found;
  Stopwatch stopwatch;
  try {
    const std::string message = scene_message(scene, budget);
    Session session(scene, client, budget, found);
    session.introduce(message);
    found.answer.setup_seconds = stopwatch.lap();
    take_answer(session, scene, found);
  } catch (const cases::SolveError& error) {
    found.answer.solution = failed_solution(error);
  }
  found.answer.solve_seconds = stopwatch.lap();
  return found;
}

std::optional<Client> read_client(const std::vector<Question>& questions, const std::string& argument) {
  if (argument.empty()) return std::nullopt;
  if (n_mpi_ranks() > 1)
    throw cases::InputError("--client: a client is asked on one rank; start the command without mpirun");
  for (const Question& question : questions) {
    cases::refuse_tools(question.scene.definition, "--client", "its protocol has no tools");
    cases::refuse_network(question.scene.definition, "--client",
                          "run without it solves the springs of the network");
    check_displacements_suffice(question.scene.definition, "--client");
  }
  return client_of(argument);
}

Answers with_client(Answers answers, const cases::Scene& scene, const Client& client) {
  ClientAnswer found = ask_client(scene, client, {});
  answers.msm = std::move(found.answer);
  answers.design.reset();
  answers.msm_name = answers.msm_source = client.name;
  answers.msm_warnings = std::move(found.warnings);
  if (!found.introduction) return answers;
  const Introduction& is = *found.introduction;
  answers.msm_source = fmt::format("{} ({} {}, {})", client.name, is.name, is.version, is.method);
  for (const std::string& ignored : is.unsupported)
    answers.msm_warnings.push_back(fmt::format("{} ignores {}", client.name, ignored));
  return answers;
}

} // namespace springproof::compare
