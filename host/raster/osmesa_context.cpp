// SPDX-License-Identifier: Apache-2.0
// Everything that calls OpenGL: context, framebuffer, shaders, one draw call.
#define GL_GLEXT_PROTOTYPES
#include "host/raster/osmesa_context.h"

#include <GL/gl.h>
#include <GL/glext.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "host/base/errors.h"

namespace turbid {
namespace {

constexpr const char* kVertexShader = R"(#version 330 core
layout(location = 0) in vec4 corner;
uniform uint first;
flat out uint number;
void main() {
  number = first + uint(gl_VertexID) / 3u;
  gl_Position = corner;
}
)";

constexpr const char* kFragmentShader = R"(#version 330 core
flat in uint number;
layout(location = 0) out uint nearest;
void main() { nearest = number; }
)";

GLuint compile(GLenum kind, const char* text) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (!good) {
    char log[1024] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    glDeleteShader(shader);
    throw DeviceError(std::string("OSMesa: the rasteriser's shader does not compile: ") + log);
  }
  return shader;
}

GLuint link_program() {
  const GLuint vertex = compile(GL_VERTEX_SHADER, kVertexShader);
  const GLuint fragment = compile(GL_FRAGMENT_SHADER, kFragmentShader);
  const GLuint program = glCreateProgram();
  glAttachShader(program, vertex);
  glAttachShader(program, fragment);
  glLinkProgram(program);
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  GLint good = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (!good) throw DeviceError("OSMesa: the rasteriser's shaders do not link");
  return program;
}

bool has_extension(std::string_view name) {
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i) {
    const auto* found = reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
    if (found && name == found) return true;
  }
  return false;
}

void require_no_error(const char* when) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  const char* reason = error == GL_OUT_OF_MEMORY ? "out of memory" : "OpenGL error";
  throw DeviceError(std::string("OSMesa: ") + reason + " " + std::to_string(error) + " while " + when);
}

}  // namespace

OsmesaContext::OsmesaContext() : window_(4 * 16 * 16) {
  const int wanted[] = {OSMESA_FORMAT,
                        OSMESA_RGBA,
                        OSMESA_PROFILE,
                        OSMESA_CORE_PROFILE,
                        OSMESA_CONTEXT_MAJOR_VERSION,
                        3,
                        OSMESA_CONTEXT_MINOR_VERSION,
                        3,
                        0};
  context_ = OSMesaCreateContextAttribs(wanted, nullptr);
  if (!context_) throw DeviceError("OSMesa: cannot make an OpenGL 3.3 core context");
  if (!OSMesaMakeCurrent(context_, window_.data(), GL_UNSIGNED_BYTE, 16, 16)) {
    OSMesaDestroyContext(context_);
    throw DeviceError("OSMesa: cannot make its context current");
  }
  if (!has_extension("GL_ARB_clip_control")) {
    OSMesaDestroyContext(context_);
    throw DeviceError("OSMesa: its driver lacks GL_ARB_clip_control; Mesa 20 or later with llvmpipe has it");
  }
}

OsmesaContext::~OsmesaContext() {
  OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
  OSMesaDestroyContext(context_);
}

NumberTarget::NumberTarget(const OsmesaContext&, int width, int height) {
  program_ = link_program();
  first_ = glGetUniformLocation(program_, "first");

  glGenRenderbuffers(1, &colour_);
  glBindRenderbuffer(GL_RENDERBUFFER, colour_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_R32UI, width, height);
  glGenRenderbuffers(1, &depth_);
  glBindRenderbuffer(GL_RENDERBUFFER, depth_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
  glGenFramebuffers(1, &framebuffer_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);

  glGenVertexArrays(1, &layout_);
  glBindVertexArray(layout_);
  glGenBuffers(1, &vertices_);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);

  glUseProgram(program_);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DITHER);
  // libOSMesa exports the functions of OpenGL 3 but not this later one.
  const auto clip_control = reinterpret_cast<PFNGLCLIPCONTROLPROC>(OSMesaGetProcAddress("glClipControl"));
  if (!clip_control) throw DeviceError("OSMesa: glClipControl is missing");
  clip_control(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  require_no_error("making the raster target");
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw DeviceError("OSMesa: its driver cannot draw to 32-bit integers with a 32-bit float depth");
}

NumberTarget::~NumberTarget() {
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteRenderbuffers(1, &colour_);
  glDeleteRenderbuffers(1, &depth_);
  glDeleteVertexArrays(1, &layout_);
  glDeleteBuffers(1, &vertices_);
  glDeleteProgram(program_);
}

int NumberTarget::largest_size(const OsmesaContext&) {
  GLint viewport[2] = {0, 0}, renderbuffer = 0;
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &renderbuffer);
  return std::min({viewport[0], viewport[1], renderbuffer});
}

void NumberTarget::clear(int width, int height) {
  const GLuint nothing[4] = {0, 0, 0, 0};
  const GLfloat far_away = 0;
  glViewport(0, 0, width, height);
  glClearBufferuiv(GL_COLOR, 0, nothing);
  glClearBufferfv(GL_DEPTH, 0, &far_away);
}

void NumberTarget::draw(std::span<const float> corners, std::uint32_t first) {
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size_bytes()), corners.data(), GL_STREAM_DRAW);
  glUniform1ui(first_, first);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners.size() / 4));
  require_no_error("drawing triangles");
}

void NumberTarget::read(int width, int height, std::uint32_t* numbers) {
  glReadPixels(0, 0, width, height, GL_RED_INTEGER, GL_UNSIGNED_INT, numbers);
  require_no_error("reading the picture back");
}

}  // namespace turbid
