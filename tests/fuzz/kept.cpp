// Kept results as a target for libFuzzer: files, answers whose digest a forger has put right, and shards'
// records.

#include "compare/solve/kept.hpp"
#include "tests/fuzz/promise.hpp"

#include <cstdint>

using namespace springproof;

namespace {

template<class Read>
void read_any(const Read& read) {
  try {
    read();
  } catch (const std::exception&) {
    // what wrong bytes are answered with
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  static const cases::Mesh mesh = cases::make_box_mesh({1, 1, 1}, {1, 1, 1});
  PROMISE(compare::result_in(compare::kept_text("cell", text), "cell") == text);
  read_any([&] { compare::result_in(text, "cell"); });
  read_any([&] {
    const auto answers = compare::result_from<compare::Answers>(text, mesh);
    if (answers.fem.converged()) PROMISE(answers.fem.solution.displacement.size() == mesh.nodes.size());
  });
  read_any([&] { compare::result_from<compare::Answer>(text, mesh); });
  read_any([&] {
    const compare::ShardRecord record = compare::record_from(text);
    PROMISE(1 <= record.shard.index && record.shard.index <= record.shard.count);
    PROMISE(compare::record_from(compare::text_of(record)).command == record.command);
  });
  return 0;
}
