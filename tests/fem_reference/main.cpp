#define CATCH_CONFIG_RUNNER
#include "fem_reference/session.hpp"

#include <catch2/catch.hpp>

int main(int argc, char** argv) {
  const fem_reference::Session session;
  return Catch::Session().run(argc, argv);
}
