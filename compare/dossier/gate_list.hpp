#pragma once

#include "compare/dossier/dossier.hpp"

/// What the sections of a dossier share: the gates that hold its numbers, and what it lacks.
namespace springproof::compare {

/// Gates by names that the document's numbers refer to.
class GateList {
 public:
  /// @param prefix  of all names
  explicit GateList(std::string prefix) : prefix_(std::move(prefix)) {}
  void add(const Comparison& comparison);

  using Names = std::vector<std::string>;
  Names names_of(const std::string& of_case, const std::string& measure) const;
  Names names_of(const std::string& of_case, const std::string& measure, cases::Quantity quantity) const;
  Names names_of(cases::ReferenceKind kind) const;

  /// [{"name", "case", "file", "line", "measure", "quantity", "kind", "asserts", "interval", "unit", "value",
  /// "uncertainty", "met", "judged", "reason"}]
  Json to_json() const;

 private:
  struct Named {
    std::string name, of_case, file;
    Gate gate;
  };
  std::string prefix_;
  std::vector<Named> all_;

  template<class Is>
  Names names_if(const Is& is_it) const {
    Names names;
    for (const Named& one : all_)
      if (is_it(one)) names.push_back(one.name);
    return names;
  }
};

/// What a dossier lacks, and what would fill it.
class MissingList {
 public:
  /// @param of_case  empty: of the whole dossier
  void add(const std::string& section, const std::string& of_case, const std::string& what,
           const std::string& filled_by);
  /// [{"section", "case", "what", "filled_by"}]
  const Json& to_json() const { return all_; }

 private:
  Json all_ = Json::array();
};

/// What the simulation is for, and its cases: bodies, materials, loads, tools and quantities of interest.
Json context_to_json(const Dossier& dossier, const GateList& gates, MissingList& missing);

/// How far the results of a case go: its mesh, materials, strains, the springs' range, and warnings.
Json applicability_to_json(const StudiedCase& studied, const Dossier& dossier, MissingList& missing);

} // namespace springproof::compare
