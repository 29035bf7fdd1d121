// Runs a check once per instruction set that this machine has, with HWY_DYNAMIC_DISPATCH going there.
#pragma once
#include <gtest/gtest.h>
#include <hwy/targets.h>

namespace metamer {

template <class Check>
void for_each_target(const Check& check) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    check();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace metamer
