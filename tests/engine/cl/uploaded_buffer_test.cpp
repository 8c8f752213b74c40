// A buffer that the host fills, and the values that it may free at once.
#include "cl/buffers.h"

#include <gtest/gtest.h>

#include <numeric>

#include "cl/transfer.h"

namespace lightgrid {
namespace {

std::vector<uint32_t> numbers(size_t count, uint32_t first) {
  std::vector<uint32_t> values(count);
  std::iota(values.begin(), values.end(), first);
  return values;
}

struct UploadedBuffers : testing::Test {
  ClDevice device;
  UploadedBuffer buffer;

  void put(std::vector<uint32_t> values) {
    buffer.put(device, "test", values);
    std::fill(values.begin(), values.end(), 0xdeadu);
  }
  std::vector<uint32_t> contents(size_t count) {
    std::vector<uint32_t> values(count);
    read_buffer(device, "test", buffer.buffer(), values.data(), count * 4);
    return values;
  }
};

// The queue waits for `gate`, so that no write has begun when put() returns.
TEST_F(UploadedBuffers, PutKeepsValuesThatAreChangedBeforeTheQueueReadsThem) {
  put(numbers(1000, 1));
  cl::UserEvent gate(device.context());
  const std::vector<cl::Event> gates{gate};
  device.queue().enqueueBarrierWithWaitList(&gates);
  for (const uint32_t first : {3, 4, 5}) put(numbers(1000, first));
  gate.setStatus(CL_COMPLETE);
  EXPECT_EQ(contents(1000), numbers(1000, 5));
}

TEST_F(UploadedBuffers, MayGoBeforeTheQueueHasReadWhatWasPut) {
  cl::UserEvent gate(device.context());
  const std::vector<cl::Event> gates{gate};
  cl::Buffer written;
  {
    UploadedBuffer gone;
    device.queue().enqueueBarrierWithWaitList(&gates);
    for (const uint32_t first : {2, 8}) gone.put(device, "test", numbers(1000, first));
    written = gone.buffer();
  }
  const std::vector<uint32_t> others(1000, 0xbeefu);  // may take the memory that is free now
  gate.setStatus(CL_COMPLETE);
  std::vector<uint32_t> values(1000);
  read_buffer(device, "test", written, values.data(), 4000);
  EXPECT_EQ(values, numbers(1000, 8));
}

// Commands between two writes read the first.
TEST_F(UploadedBuffers, PutFollowsWhatIsInTheQueue) {
  const cl::Buffer copy(device.context(), CL_MEM_READ_WRITE, 4000);
  put(numbers(1000, 1));
  copy_buffer(device, "test", buffer.buffer(), copy, 4000);
  put(numbers(1000, 7));
  std::vector<uint32_t> copied(1000);
  read_buffer(device, "test", copy, copied.data(), 4000);
  EXPECT_EQ(copied, numbers(1000, 1));
  EXPECT_EQ(contents(1000), numbers(1000, 7));
}

TEST_F(UploadedBuffers, RoomStaysWhileValuesFitAndGoesWhenTheyAreFew) {
  put(numbers(1000, 1));
  const cl_mem room = buffer.buffer()();
  for (const size_t count : {999, 251, 1000}) {
    put(numbers(count, 3));
    EXPECT_EQ(contents(count), numbers(count, 3));
    EXPECT_EQ(buffer.buffer()(), room) << count;
    EXPECT_EQ(buffer.bytes(), 4000u);
  }
  put(numbers(249, 2));
  EXPECT_EQ(contents(249), numbers(249, 2));
  EXPECT_EQ(buffer.bytes(), 249u * 4);
  put({});
  EXPECT_EQ(buffer.bytes(), 16u) << "OpenCL makes no empty buffer";
}

// More than is copied: waits instead.
TEST_F(UploadedBuffers, LargeOnes) {
  for (const size_t count : {size_t(1) << 18, (size_t(1) << 18) + 1, size_t(1) << 20}) {
    put(numbers(count, 9));
    EXPECT_EQ(contents(count), numbers(count, 9));
  }
}

}  // namespace
}  // namespace lightgrid
