// OpenGL 4.5 core: types from Khronos' glcorearb.h, functions found at run time by the current context's
// loader. Functions keep their OpenGL names; add a line to the list to load another.
#pragma once

#include <GL/glcorearb.h>

#include <string>
#include <string_view>

// clang-format off
#define LIGHTGRID_GL_FUNCTIONS(X) \
  X(PFNGLATTACHSHADERPROC, glAttachShader) X(PFNGLBINDBUFFERPROC, glBindBuffer) \
  X(PFNGLBINDBUFFERBASEPROC, glBindBufferBase) X(PFNGLBINDBUFFERRANGEPROC, glBindBufferRange) \
  X(PFNGLBINDFRAMEBUFFERPROC, glBindFramebuffer) X(PFNGLBINDSAMPLERPROC, glBindSampler) \
  X(PFNGLBINDTEXTUREUNITPROC, glBindTextureUnit) X(PFNGLBINDVERTEXARRAYPROC, glBindVertexArray) \
  X(PFNGLBLENDEQUATIONPROC, glBlendEquation) X(PFNGLBLENDFUNCPROC, glBlendFunc) \
  X(PFNGLBLENDFUNCSEPARATEPROC, glBlendFuncSeparate) \
  X(PFNGLCHECKNAMEDFRAMEBUFFERSTATUSPROC, glCheckNamedFramebufferStatus) X(PFNGLCLEARPROC, glClear) \
  X(PFNGLCLEARCOLORPROC, glClearColor) X(PFNGLCLEARNAMEDFRAMEBUFFERFVPROC, glClearNamedFramebufferfv) \
  X(PFNGLCLEARNAMEDBUFFERSUBDATAPROC, glClearNamedBufferSubData) \
  X(PFNGLCLEARNAMEDFRAMEBUFFERUIVPROC, glClearNamedFramebufferuiv) X(PFNGLCLIPCONTROLPROC, glClipControl) \
  X(PFNGLCOLORMASKPROC, glColorMask) X(PFNGLCOMPILESHADERPROC, glCompileShader) \
  X(PFNGLCOPYNAMEDBUFFERSUBDATAPROC, glCopyNamedBufferSubData) X(PFNGLCREATEBUFFERSPROC, glCreateBuffers) \
  X(PFNGLCREATEFRAMEBUFFERSPROC, glCreateFramebuffers) X(PFNGLCREATEPROGRAMPROC, glCreateProgram) \
  X(PFNGLCREATESAMPLERSPROC, glCreateSamplers) X(PFNGLCREATESHADERPROC, glCreateShader) \
  X(PFNGLCREATETEXTURESPROC, glCreateTextures) X(PFNGLCREATEVERTEXARRAYSPROC, glCreateVertexArrays) \
  X(PFNGLCULLFACEPROC, glCullFace) X(PFNGLDEBUGMESSAGECALLBACKPROC, glDebugMessageCallback) \
  X(PFNGLDELETEBUFFERSPROC, glDeleteBuffers) X(PFNGLDELETEFRAMEBUFFERSPROC, glDeleteFramebuffers) \
  X(PFNGLDELETEPROGRAMPROC, glDeleteProgram) X(PFNGLDELETESAMPLERSPROC, glDeleteSamplers) \
  X(PFNGLDELETESHADERPROC, glDeleteShader) X(PFNGLDELETETEXTURESPROC, glDeleteTextures) \
  X(PFNGLDELETEVERTEXARRAYSPROC, glDeleteVertexArrays) X(PFNGLDEPTHFUNCPROC, glDepthFunc) \
  X(PFNGLDEPTHMASKPROC, glDepthMask) X(PFNGLDISABLEPROC, glDisable) \
  X(PFNGLDISPATCHCOMPUTEPROC, glDispatchCompute) X(PFNGLDRAWARRAYSPROC, glDrawArrays) \
  X(PFNGLDRAWELEMENTSBASEVERTEXPROC, glDrawElementsBaseVertex) \
  X(PFNGLMULTIDRAWELEMENTSBASEVERTEXPROC, glMultiDrawElementsBaseVertex) X(PFNGLENABLEPROC, glEnable) \
  X(PFNGLENABLEVERTEXARRAYATTRIBPROC, glEnableVertexArrayAttrib) X(PFNGLFINISHPROC, glFinish) \
  X(PFNGLFLUSHPROC, glFlush) X(PFNGLFRONTFACEPROC, glFrontFace) \
  X(PFNGLGENERATETEXTUREMIPMAPPROC, glGenerateTextureMipmap) X(PFNGLGETACTIVEUNIFORMPROC, glGetActiveUniform) \
  X(PFNGLGETACTIVEUNIFORMBLOCKNAMEPROC, glGetActiveUniformBlockName) X(PFNGLGETERRORPROC, glGetError) \
  X(PFNGLGETINTEGERVPROC, glGetIntegerv) X(PFNGLGETINTEGER64VPROC, glGetInteger64v) \
  X(PFNGLGETMULTISAMPLEFVPROC, glGetMultisamplefv) \
  X(PFNGLGETNAMEDBUFFERSUBDATAPROC, glGetNamedBufferSubData) \
  X(PFNGLGETNAMEDFRAMEBUFFERATTACHMENTPARAMETERIVPROC, glGetNamedFramebufferAttachmentParameteriv) \
  X(PFNGLGETPROGRAMINFOLOGPROC, glGetProgramInfoLog) \
  X(PFNGLGETPROGRAMIVPROC, glGetProgramiv) X(PFNGLGETSHADERINFOLOGPROC, glGetShaderInfoLog) \
  X(PFNGLGETSHADERIVPROC, glGetShaderiv) X(PFNGLGETSTRINGPROC, glGetString) X(PFNGLGETSTRINGIPROC, glGetStringi) \
  X(PFNGLGETTEXTUREIMAGEPROC, glGetTextureImage) X(PFNGLGETUNIFORMLOCATIONPROC, glGetUniformLocation) \
  X(PFNGLLINKPROGRAMPROC, glLinkProgram) X(PFNGLMAPNAMEDBUFFERRANGEPROC, glMapNamedBufferRange) \
  X(PFNGLMEMORYBARRIERPROC, glMemoryBarrier) X(PFNGLNAMEDBUFFERSTORAGEPROC, glNamedBufferStorage) \
  X(PFNGLNAMEDBUFFERSUBDATAPROC, glNamedBufferSubData) \
  X(PFNGLNAMEDFRAMEBUFFERDRAWBUFFERPROC, glNamedFramebufferDrawBuffer) \
  X(PFNGLNAMEDFRAMEBUFFERDRAWBUFFERSPROC, glNamedFramebufferDrawBuffers) \
  X(PFNGLNAMEDFRAMEBUFFERREADBUFFERPROC, glNamedFramebufferReadBuffer) \
  X(PFNGLNAMEDFRAMEBUFFERTEXTUREPROC, glNamedFramebufferTexture) X(PFNGLPIXELSTOREIPROC, glPixelStorei) \
  X(PFNGLPROGRAMUNIFORM1IVPROC, glProgramUniform1iv) X(PFNGLREADBUFFERPROC, glReadBuffer) \
  X(PFNGLREADPIXELSPROC, glReadPixels) X(PFNGLSAMPLERPARAMETERIPROC, glSamplerParameteri) \
  X(PFNGLSAMPLERPARAMETERFPROC, glSamplerParameterf) X(PFNGLSCISSORPROC, glScissor) \
  X(PFNGLSHADERSOURCEPROC, glShaderSource) X(PFNGLTEXTUREBUFFERPROC, glTextureBuffer) \
  X(PFNGLTEXTUREPARAMETERIPROC, glTextureParameteri) X(PFNGLTEXTURESTORAGE2DPROC, glTextureStorage2D) \
  X(PFNGLTEXTURESTORAGE2DMULTISAMPLEPROC, glTextureStorage2DMultisample) \
  X(PFNGLTEXTURESTORAGE3DPROC, glTextureStorage3D) X(PFNGLTEXTURESUBIMAGE3DPROC, glTextureSubImage3D) \
  X(PFNGLTEXTURESUBIMAGE2DPROC, glTextureSubImage2D) X(PFNGLUNIFORM1IPROC, glUniform1i) \
  X(PFNGLUNIFORM1UIPROC, glUniform1ui) X(PFNGLUNIFORM1FPROC, glUniform1f) X(PFNGLUNIFORM1FVPROC, glUniform1fv) \
  X(PFNGLUNIFORMMATRIX3FVPROC, glUniformMatrix3fv) X(PFNGLUNIFORMMATRIX4FVPROC, glUniformMatrix4fv) \
  X(PFNGLUNIFORMBLOCKBINDINGPROC, glUniformBlockBinding) X(PFNGLUSEPROGRAMPROC, glUseProgram) \
  X(PFNGLVERTEXARRAYATTRIBBINDINGPROC, glVertexArrayAttribBinding) \
  X(PFNGLVERTEXARRAYATTRIBFORMATPROC, glVertexArrayAttribFormat) \
  X(PFNGLVERTEXARRAYELEMENTBUFFERPROC, glVertexArrayElementBuffer) \
  X(PFNGLVERTEXARRAYVERTEXBUFFERPROC, glVertexArrayVertexBuffer) X(PFNGLVIEWPORTPROC, glViewport) \
  X(PFNGLBLENDCOLORPROC, glBlendColor) X(PFNGLCOLORMASKIPROC, glColorMaski) \
  X(PFNGLSTENCILFUNCPROC, glStencilFunc) X(PFNGLSTENCILOPPROC, glStencilOp) \
  X(PFNGLSTENCILOPSEPARATEPROC, glStencilOpSeparate) X(PFNGLSTENCILMASKPROC, glStencilMask) \
  X(PFNGLGETTEXTURELEVELPARAMETERIVPROC, glGetTextureLevelParameteriv) \
  X(PFNGLDRAWELEMENTSINSTANCEDBASEVERTEXBASEINSTANCEPROC, glDrawElementsInstancedBaseVertexBaseInstance) \
  X(PFNGLVERTEXARRAYBINDINGDIVISORPROC, glVertexArrayBindingDivisor) \
  X(PFNGLVERTEXARRAYATTRIBIFORMATPROC, glVertexArrayAttribIFormat) X(PFNGLUNIFORM2IPROC, glUniform2i) X(PFNGLUNIFORM2UIPROC, glUniform2ui) \
  X(PFNGLUNIFORM2FPROC, glUniform2f) X(PFNGLBINDIMAGETEXTUREPROC, glBindImageTexture) \
  X(PFNGLCLEARNAMEDFRAMEBUFFERIVPROC, glClearNamedFramebufferiv) \
  X(PFNGLBLITNAMEDFRAMEBUFFERPROC, glBlitNamedFramebuffer) X(PFNGLFENCESYNCPROC, glFenceSync) \
  X(PFNGLCLIENTWAITSYNCPROC, glClientWaitSync) X(PFNGLDELETESYNCPROC, glDeleteSync) \
  X(PFNGLCREATEQUERIESPROC, glCreateQueries) X(PFNGLDELETEQUERIESPROC, glDeleteQueries) \
  X(PFNGLQUERYCOUNTERPROC, glQueryCounter) X(PFNGLGETQUERYOBJECTUI64VPROC, glGetQueryObjectui64v) \
  X(PFNGLGETQUERYIVPROC, glGetQueryiv)
// clang-format on

namespace lightgrid {

#define LIGHTGRID_GL_DECLARE(type, name) extern type name;
LIGHTGRID_GL_FUNCTIONS(LIGHTGRID_GL_DECLARE)
#undef LIGHTGRID_GL_DECLARE

// GL_EXT_memory_object and GL_EXT_memory_object_fd: buffers over memory that another API allocated.
// glcorearb.h lacks them. Null where the driver has none; some drivers return functions that they do not
// support, so has_gl_extension decides.
using CreateMemoryObjects = void(APIENTRYP)(GLsizei count, GLuint* objects);
using DeleteMemoryObjects = void(APIENTRYP)(GLsizei count, const GLuint* objects);
using MemoryObjectParameteriv = void(APIENTRYP)(GLuint object, GLenum parameter, const GLint* values);
using ImportMemoryFd = void(APIENTRYP)(GLuint object, GLuint64 bytes, GLenum handle_type, GLint fd);
using NamedBufferStorageMem = void(APIENTRYP)(GLuint buffer, GLsizeiptr bytes, GLuint object,
                                              GLuint64 offset);
using GetUnsignedBytei_v = void(APIENTRYP)(GLenum name, GLuint index, GLubyte* bytes);
inline constexpr GLenum dedicated_memory_object = 0x9581, handle_type_opaque_fd = 0x9586,
                        num_device_uuids = 0x9596, device_uuid = 0x9597;
// clang-format off
#define LIGHTGRID_GL_MEMORY_FUNCTIONS(X) \
  X(CreateMemoryObjects, glCreateMemoryObjectsEXT) \
  X(DeleteMemoryObjects, glDeleteMemoryObjectsEXT) \
  X(MemoryObjectParameteriv, glMemoryObjectParameterivEXT) \
  X(ImportMemoryFd, glImportMemoryFdEXT) \
  X(NamedBufferStorageMem, glNamedBufferStorageMemEXT) \
  X(GetUnsignedBytei_v, glGetUnsignedBytei_vEXT)
// clang-format on

#define LIGHTGRID_GL_DECLARE(type, name) extern type name;
LIGHTGRID_GL_MEMORY_FUNCTIONS(LIGHTGRID_GL_DECLARE)
#undef LIGHTGRID_GL_DECLARE

// Asks the current context.
bool has_gl_extension(std::string_view name);

// Loads the functions of the current context. Throws Error(machine) naming the first of the core that is
// missing.
void load_gl_functions(void* (*get_proc_address)(const char*));

std::string gl_error_name(GLenum error);

// Throws Error(machine) that names the error and `where` if one is pending, and clears all pending errors.
// Debug builds abort at the failing call; release builds detect it here.
void check_gl(const char* where);

}  // namespace lightgrid
