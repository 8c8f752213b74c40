// The setting samples: which techniques take it, and the pictures of those that do.
#include <gmock/gmock.h>

#include "base/error.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

TEST(Samples, AreTakenByTechniquesThatDeclareThemAndRefusedByOthersByName) {
  const SmallScene s = small_scene();
  GpuScene gpu(test_devices(), s.scene);
  for (const Technique* technique : techniques()) {
    const bool declared = reads_setting(*technique, "samples");
    Settings settings;
    apply_setting(settings, "samples=8");
    if (most_samples(*technique, settings) > 1) EXPECT_TRUE(declared) << technique->name;
    if (declared) continue;
    try {
      TechniqueRun run(test_devices(), gpu, small_view(17, 9), settings, *technique);
      ADD_FAILURE() << technique->name;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_THAT(error.what(), HasSubstr("samples=8")) << technique->name;
      EXPECT_THAT(error.what(), HasSubstr(technique->name));
    }
  }
}

}  // namespace
}  // namespace lightgrid
