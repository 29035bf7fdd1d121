#include "engine/schedule/workers.h"

#include <gtest/gtest.h>

#include <limits>
#include <thread>
#include <vector>

namespace metamer {
namespace {

struct Record {
  explicit Record(size_t units, uint32_t threads) : begun(units), held(threads) {}
  std::vector<std::atomic<int>> begun;  // how often each unit was
  std::vector<std::atomic<int>> held;   // by how many threads each worker is
  std::atomic<size_t> count{0};
  std::atomic<bool> shared{false}, subnormal{false};
  size_t cancel_at = std::numeric_limits<size_t>::max();
  Cancellation cancellation;
};

void note(void* context, uint32_t worker, size_t unit) {
  Record& record = *static_cast<Record*>(context);
  if (record.held[worker].fetch_add(1) != 0) record.shared = true;
  ++record.begun[unit];
  ++record.count;
  volatile float smallest = std::numeric_limits<float>::min();
  if (smallest / 2 != 0) record.subnormal = true;
  if (unit == record.cancel_at) record.cancellation.request();
  // Later units wait for the cancellation, so that what follows it is known.
  while (unit > record.cancel_at && !record.cancellation.requested()) std::this_thread::yield();
  record.held[worker].fetch_sub(1);
}

TEST(Workers, DoEveryUnitOnce) {
  for (const uint32_t threads : {1u, 2u, 5u}) {
    Record record(1000, threads);
    run_units(threads, 1000, record.cancellation, note, &record);
    for (const auto& times : record.begun) ASSERT_EQ(times, 1);
    EXPECT_FALSE(record.shared) << "a worker's memory belongs to one thread at a time";
    EXPECT_FALSE(record.subnormal) << "subnormal numbers count as zero while pixels are computed";
  }
}

TEST(Workers, BeginUnitsInOrder) {
  Record record(1000, 1);
  run_units(
      1, 1000, record.cancellation,
      [](void* context, uint32_t, size_t unit) { EXPECT_EQ(static_cast<Record*>(context)->count++, unit); }, &record);
  EXPECT_EQ(record.count, 1000u);
}

TEST(Workers, BeginNothingAfterACancellation) {
  for (const uint32_t threads : {1u, 3u}) {
    Record record(1000, threads);
    record.cancel_at = 100;
    run_units(threads, 1000, record.cancellation, note, &record);
    EXPECT_LE(record.count, 100u + threads);
    for (size_t unit = 0; unit <= 100; ++unit) EXPECT_EQ(record.begun[unit], 1) << "begun before it";
  }
  Record record(10, 2);
  record.cancellation.request();
  run_units(2, 10, record.cancellation, note, &record);
  EXPECT_EQ(record.count, 0u);
}

TEST(Workers, LeaveTheCallersFloatingPointModeAlone) {
  Record record(10, 2);
  run_units(2, 10, record.cancellation, note, &record);
  volatile float smallest = std::numeric_limits<float>::min();
  EXPECT_NE(smallest / 2, 0);
}

TEST(Workers, ThereIsAtLeastOneThread) {
  EXPECT_GE(available_threads(), 1u);
  EXPECT_LE(available_threads(), std::max(1u, std::thread::hardware_concurrency()));
}

}  // namespace
}  // namespace metamer
