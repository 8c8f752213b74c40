// Files, containers, URIs and their errors.
#include <sys/stat.h>

#include "support/gltf_builder.h"

namespace lightgrid {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::vector<glm::vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

GltfBuilder with_buffer_uri(const std::string& uri) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["buffers"] = {{{"byteLength", made.bin.size()}, {"uri", uri}}};
  return made;
}

TEST(GltfFile, a_glb_is_known_by_its_content_and_not_by_its_name) {
  const ModelFolder folder;
  const Scene scene = load_gltf(folder.write("named.gltf", GltfBuilder::triangle().glb()));
  EXPECT_EQ(scene.meshes.at(0).positions, corners);
  EXPECT_EQ(load_gltf(folder.write("named.glb", GltfBuilder::triangle().text())).meshes.at(0).positions,
            corners);
}

TEST(GltfFile, the_scene_is_named_after_the_file) { EXPECT_EQ(GltfBuilder::triangle().load().name, "made"); }

TEST(GltfFile, chunks_of_unknown_type_after_the_binary_one_are_passed_over) {
  Bytes bytes = GltfBuilder::triangle().glb();
  const Bytes extra = bytes_of(std::vector<uint32_t>{4, 0x12345678, 99});
  bytes.insert(bytes.end(), extra.begin(), extra.end());
  bytes[8] = static_cast<uint8_t>(bytes.size());
  bytes[9] = static_cast<uint8_t>(bytes.size() >> 8);
  const ModelFolder folder;
  EXPECT_EQ(load_gltf(folder.write("a.glb", bytes)).meshes.at(0).positions, corners);
}

TEST(GltfFile, every_cut_of_a_glb_is_an_input_error) {
  const Bytes whole = GltfBuilder::triangle().glb();
  const ModelFolder folder;
  for (size_t size = 0; size < whole.size(); ++size) {
    const auto path = folder.write("cut.glb", Bytes(whole.begin(), whole.begin() + size));
    EXPECT_THAT(refusal_of(path), HasSubstr("cut.glb: ")) << size;
  }
}

TEST(GltfFile, missing_files_folders_empty_files_and_pipes_are_named_as_such) {
  const ModelFolder folder;
  EXPECT_THAT(refusal_of(folder.path / "none.gltf"),
              AllOf(HasSubstr("none.gltf: cannot be read: "), HasSubstr("No such file")));
  EXPECT_THAT(refusal_of(folder.path), HasSubstr("is a folder, not a file"));
  EXPECT_THAT(refusal_of(folder.write("empty.gltf", Bytes())), HasSubstr("empty.gltf: is empty"));
  ASSERT_EQ(mkfifo((folder.path / "pipe.gltf").c_str(), 0600), 0);
  EXPECT_THAT(refusal_of(folder.path / "pipe.gltf"), HasSubstr("is not a regular file"));
  EXPECT_THAT(refusal_of("/dev/zero"), HasSubstr("is not a regular file"));
}

TEST(GltfFile, text_that_is_no_json_object_is_refused) {
  const ModelFolder folder;
  EXPECT_THAT(refusal_of(folder.write("a.gltf", "solid cube")),
              HasSubstr("neither a GLB file nor a JSON object"));
  EXPECT_THAT(refusal_of(folder.write("a.gltf", "[1]")), HasSubstr("neither a GLB file nor a JSON object"));
  EXPECT_THAT(refusal_of(folder.write("a.gltf", "{\"asset\": ")), HasSubstr("parse error at line 1"));
  EXPECT_THAT(refusal_of(folder.write("a.gltf", "{}")), HasSubstr("asset"));
}

TEST(GltfFile, nesting_deeper_than_any_gltf_is_refused_and_not_followed) {
  const ModelFolder folder;
  const std::string deep = std::string(200000, '[') + std::string(200000, ']');
  EXPECT_THAT(
      refusal_of(folder.write("deep.gltf", "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + deep + "}")),
      HasSubstr("nested deeper than 64"));
}

TEST(GltfFile, only_version_2_is_read) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["asset"]["version"] = "1.0";
  EXPECT_EQ(made.refusal(), "made.gltf: asset.version is \"1.0\"; only glTF 2 is read");
  made.root["asset"]["version"] = "2.1";  // by the specification, any minor version
  EXPECT_EQ(made.load().meshes.size(), 1u);
  made.root["asset"]["minVersion"] = "2.1";
  EXPECT_THAT(made.refusal(), HasSubstr("minVersion is \"2.1\""));
}

TEST(GltfFile, buffers_are_found_by_relative_and_percent_encoded_uris) {
  const ModelFolder folder;
  const Bytes bin = GltfBuilder::triangle().bin;
  folder.write("sub folder/a+b.bin", bin);
  folder.write("❤♻.bin", bin);
  for (const char* uri : {"sub%20folder/a+b.bin", "sub folder/a%2Bb.bin",
                          "./sub%20folder/../sub%20folder/a+b.bin", "%E2%9D%A4%e2%99%bb.bin", "❤♻.bin"}) {
    const Scene scene = load_gltf(folder.write("a.gltf", with_buffer_uri(uri).text()));
    EXPECT_EQ(scene.meshes.at(0).positions, corners) << uri;
  }
}

TEST(GltfFile, a_data_uri_needs_neither_a_media_type_nor_base64) {
  GltfBuilder made = GltfBuilder::triangle();
  std::string percent;
  for (uint8_t byte : made.bin) percent += fmt::format("%{:02X}", byte);
  for (const std::string& uri : {"data:;base64," + base64(made.bin),
                                 "data:text/plain;charset=x;base64," + base64(made.bin), "data:," + percent})
    EXPECT_EQ(with_buffer_uri(uri).load().meshes.at(0).positions, corners) << uri;
  EXPECT_THAT(with_buffer_uri("data:;base64,A*==").refusal(), HasSubstr("buffer 0: data URI is not base64"));
  EXPECT_THAT(with_buffer_uri("data:;base64").refusal(), HasSubstr("data URI has no comma"));
}

TEST(GltfFile, a_percent_sign_without_digits_is_itself) {
  GltfBuilder made = GltfBuilder::triangle();
  const ModelFolder folder;
  for (const char* name : {"100%.bin", "5% grey.bin", "%zz.bin"}) {
    folder.write(name, made.bin);
    EXPECT_EQ(load_gltf(folder.write("a.gltf", with_buffer_uri(name).text())).meshes.at(0).positions, corners)
        << name;
  }
}

TEST(GltfFile, nothing_outside_the_folder_is_read) {
  const ModelFolder outside;
  const auto secret = outside.write("secret.bin", GltfBuilder::triangle().bin);
  const ModelFolder folder;
  std::filesystem::create_symlink(secret, folder.path / "link.bin");
  std::filesystem::create_directory_symlink(outside.path, folder.path / "linked");
  const std::string up = "../" + outside.path.filename().string() + "/secret.bin";
  for (const std::string& uri : {secret.string(), up, std::string("%2E%2E/") + up.substr(3),
                                 std::string("link.bin"), std::string("linked/secret.bin")})
    EXPECT_THAT(refusal_of(folder.write("a.gltf", with_buffer_uri(uri).text())),
                HasSubstr("leaves the folder of the glTF file; --files anywhere reads it"))
        << uri;
  for (const char* uri : {"http://example.com/a.bin", "file:///etc/passwd"})
    EXPECT_THAT(with_buffer_uri(uri).refusal(), HasSubstr("only relative paths and data URIs are read"));
  EXPECT_THAT(with_buffer_uri("a%00b").refusal(), HasSubstr("is not a valid path"));
  EXPECT_THAT(with_buffer_uri("a%2").refusal(), HasSubstr("file \"a%2\" cannot be read"));
}

TEST(GltfFile, files_anywhere_are_read_when_allowed) {
  const ModelFolder folder;
  const auto bin = folder.write("shared.bin", GltfBuilder::triangle().bin);
  folder.write("models/beside.bin", GltfBuilder::triangle().bin);
  std::filesystem::create_symlink(bin, folder.path / "models/link.bin");
  for (const std::string& uri : {std::string("../shared.bin"), bin.string(), std::string("link.bin"),
                                 std::string("beside.bin"), std::string("..\\shared.bin")}) {
    const auto path = folder.write("models/a.gltf", with_buffer_uri(uri).text());
    EXPECT_EQ(load_gltf(path, -1, {.files_anywhere = true}).meshes.at(0).positions, corners) << uri;
  }
}

TEST(GltfFile, a_links_folder_is_that_of_its_target_and_its_own) {
  const ModelFolder store, links;
  store.write("a.bin", GltfBuilder::triangle().bin);
  const auto target = store.write("a.gltf", with_buffer_uri("a.bin").text());
  std::filesystem::create_symlink(target, links.path / "linked.gltf");
  EXPECT_EQ(load_gltf(links.path / "linked.gltf").meshes.at(0).positions, corners);
  const auto other = store.write("b.gltf", with_buffer_uri("beside_link.bin").text());
  links.write("beside_link.bin", GltfBuilder::triangle().bin);
  std::filesystem::create_symlink(other, links.path / "b.gltf");
  EXPECT_EQ(load_gltf(links.path / "b.gltf").meshes.at(0).positions, corners);
  const auto missing = store.write("c.gltf", with_buffer_uri("none.bin").text());
  std::filesystem::create_symlink(missing, links.path / "c.gltf");
  EXPECT_THAT(refusal_of(links.path / "c.gltf"), HasSubstr("file \"none.bin\" cannot be read: No such file"));
}

TEST(GltfFile, backslashes_are_tried_as_slashes_with_a_warning) {
  const ModelFolder folder;
  folder.write("sub/b.bin", GltfBuilder::triangle().bin);
  for (const char* uri : {"sub\\b.bin", ".\\sub%5Cb.bin"}) {
    const auto path = folder.write("a.gltf", with_buffer_uri(uri).text());
    EXPECT_THAT(warnings_of([&] { EXPECT_EQ(load_gltf(path).meshes.at(0).positions, corners) << uri; }),
                HasSubstr("has backslashes; read as"));
  }
  folder.write("odd\\name.bin", GltfBuilder::triangle().bin);  // Linux allows it
  const auto odd = folder.write("a.gltf", with_buffer_uri("odd\\name.bin").text());
  EXPECT_EQ(warnings_of([&] { EXPECT_EQ(load_gltf(odd).meshes.at(0).positions, corners); }), "");
  EXPECT_THAT(refusal_of(folder.write("a.gltf", with_buffer_uri("..\\secret.bin").text())),
              HasSubstr("leaves the folder"));
}

TEST(GltfFile, the_folder_of_a_bare_file_name_is_the_working_directory) {
  const ModelFolder folder;
  const Bytes bin = GltfBuilder::triangle().bin;
  folder.write("a.bin", bin);
  folder.write("inner/b.bin", bin);
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path / "inner");
  folder.write("inner/out.gltf", with_buffer_uri("../a.bin").text());
  folder.write("inner/in.gltf", with_buffer_uri("b.bin").text());
  EXPECT_THAT(refusal_of("out.gltf"), HasSubstr("leaves the folder"));
  EXPECT_EQ(load_gltf("in.gltf").meshes.at(0).positions, corners);
  std::filesystem::current_path(before);
}

TEST(GltfFile, a_buffer_shorter_than_it_says_is_refused_and_a_longer_one_read) {
  const ModelFolder folder;
  Bytes bin = GltfBuilder::triangle().bin;
  bin.pop_back();
  folder.write("a.bin", bin);
  const auto path = folder.write("a.gltf", with_buffer_uri("a.bin").text());
  EXPECT_THAT(refusal_of(path), HasSubstr("buffer 0: byteLength is 36, but there are 35 bytes"));
  bin.resize(100);
  bin[35] = 0;
  folder.write("a.bin", bin);
  EXPECT_EQ(load_gltf(path).meshes.at(0).positions, corners);
}

TEST(GltfFile, files_over_the_limit_are_not_read) {
  EXPECT_THAT(GltfBuilder::triangle().refusal({.max_file_bytes = 100}), HasSubstr("at most 100 are read"));
}

TEST(GltfFile, a_message_is_one_line_whatever_names_the_file_holds) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["meshes"][0]["name"] = "evil\n\x1b[31mname" + std::string(100000, 'x');
  made.primitive()["mode"] = 9;
  const std::string message = made.refusal();
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_EQ(message.find('\x1b'), std::string::npos);
  EXPECT_LT(message.size(), 700u);
  EXPECT_THAT(message, StartsWith("made.gltf: mesh 0 \"evil"));
}

TEST(GltfFile, loading_twice_gives_the_same_scene) {
  const Scene a = GltfBuilder::triangle().load(), b = GltfBuilder::triangle().load();
  EXPECT_EQ(a.meshes[0].normals, b.meshes[0].normals);
  EXPECT_EQ(a.instances[0].world_from_object, b.instances[0].world_from_object);
}

}  // namespace
}  // namespace lightgrid
