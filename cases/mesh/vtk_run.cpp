#include "cases/mesh/vtk_run.hpp"

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
  /// Legacy files that end too early are no errors to VTK.
  void DisplayGenericWarningText(const char* message) override {
    const std::string warning = without_place(message);
    if (text.empty() && warning.rfind("Error reading", 0) == 0) text = warning;
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

} // namespace

void run(vtkAlgorithm& algorithm) {
  const vtkNew<FirstError> error;
  vtkOutputWindow::SetInstance(error);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkSMPTools::SetBackend("Sequential"); // confined processes may not start threads
  algorithm.Update();
  if (!error->text.empty()) throw std::runtime_error(error->text);
}

} // namespace springproof::cases
