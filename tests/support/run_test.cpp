#include <support/run.h>

#include <gtest/gtest.h>
#include <snug/collide.h>

namespace snug::run_test {
namespace {

TEST(run, without_a_monitor_goes_on) {
  EXPECT_NO_THROW(monitor_of({}).report(0.5));
  EXPECT_NO_THROW(stop_only({}).checkpoint());
}

TEST(run, stops_with_its_monitor_and_reports_nothing_for_parts_of_a_work) {
  std::atomic<bool> stop{false};
  int reports = 0;
  const WorkMonitor monitor{.on_progress = [&](double) { ++reports; }, .stop = &stop};
  const snug::Run run{.monitor = &monitor};
  const WorkMonitor part = stop_only(run);
  monitor_of(run).report(0.5);
  part.report(0.5);
  EXPECT_EQ(reports, 1);
  stop = true;
  EXPECT_THROW(monitor_of(run).checkpoint(), Interrupted);
  EXPECT_THROW(part.checkpoint(), Interrupted);
}

TEST(run, outcomes_name_why_a_search_ended) {
  EXPECT_EQ(outcome_of(true, true), Outcome::complete);
  EXPECT_EQ(outcome_of(false, true), Outcome::budget_spent);
  EXPECT_EQ(outcome_of(false, false), Outcome::at_rounding);
  EXPECT_STREQ(name_of(Outcome::complete), "complete");
  EXPECT_STREQ(name_of(Outcome::budget_spent), "budget-spent");
  EXPECT_STREQ(name_of(Outcome::at_rounding), "at-rounding");
}

TEST(run, of_two_outcomes_the_spent_budget_counts_most) {
  constexpr Outcome all[] = {Outcome::complete, Outcome::at_rounding, Outcome::budget_spent};
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) EXPECT_EQ(worse(all[a], all[b]), all[std::max(a, b)]);
  }
}

}  // namespace
}  // namespace snug::run_test
