#include "cases/mesh/vtk_parts.hpp"

#include <stdexcept>
#include <vtkAlgorithm.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSMPTools.h>

namespace springproof::cases {

namespace {

/// Keeps the first of VTK's errors, without the place in VTK's source.
class FirstError : public vtkOutputWindow {
 public:
  static FirstError* New();
  /// @param message  "ERROR: In FILE, line N\nCLASS (ADDRESS): TEXT\n\n"
  void DisplayErrorText(const char* message) override {
    if (text.empty()) text = without_place(message);
  }
  /// Legacy files and pictures that end too early are no errors to VTK.
  void DisplayGenericWarningText(const char* message) override {
    const std::string warning = without_place(message);
    const auto says = [&](const char* words) { return warning.rfind(words, 0) == 0; };
    if (text.empty() && (says("Error reading") || says("File operation failed"))) text = warning;
  }
  void DisplayText(const char*) override {} // other warnings
  std::string text;

 private:
  static std::string without_place(std::string message) {
    const std::size_t address = message.find("): "), line = message.find('\n');
    if (address != std::string::npos)
      message.erase(0, address + 3);
    else if (line != std::string::npos)
      message.erase(0, line + 1);
    message.erase(message.find_last_not_of(" \n") + 1);
    return message;
  }
};
vtkStandardNewMacro(FirstError)

    template<class Action>
    void run_quietly(const Action& action) {
  const vtkNew<FirstError> error;
  vtkOutputWindow::SetInstance(error);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkSMPTools::SetBackend("Sequential"); // confined processes may not start threads
  action();
  if (!error->text.empty()) throw std::runtime_error(error->text);
}

} // namespace

void run(vtkAlgorithm& algorithm) {
  run_quietly([&] { algorithm.Update(); });
}

void run_information(vtkAlgorithm& algorithm) {
  run_quietly([&] { algorithm.UpdateInformation(); });
}

} // namespace springproof::cases
