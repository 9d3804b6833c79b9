#include "demo_logger/pipelines/check.h"

#include <algorithm>

#include "check_parts.h"

namespace demo_logger {

CheckResult check(const Demonstration& demonstration, const CheckLimits& limits) {
  CheckResult result;
  result.summary = summarise(demonstration);
  Findings findings(limits.shown);
  checkTiming(demonstration, result.summary, limits, findings);
  checkCommands(demonstration, limits, findings);
  checkMissingValues(demonstration, limits, findings);
  checkMotion(demonstration, result.summary, limits, findings);
  checkOrientations(demonstration, limits, findings);
  checkMetadata(demonstration.metadata, findings);
  result.findings = findings.take();
  return result;
}

bool hasErrors(const CheckResult& result) {
  return std::any_of(result.findings.begin(), result.findings.end(),
                     [](const Finding& finding) { return finding.severity == Severity::error; });
}

}  // namespace demo_logger
