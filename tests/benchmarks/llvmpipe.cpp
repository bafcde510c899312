// MuJoCo's own renderer in software (Mesa's llvmpipe, one thread, no display): a picture, and ids in a second pass.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <benchmark/benchmark.h>
#include <stdlib.h>

#include <algorithm>
#include <vector>

#include "bare_mujoco.hpp"
#include "benchmarks.hpp"

namespace lgabench {
namespace {

struct Size {
  int rows, columns;
};
constexpr Size tabletop_picture{128, 256}, mobile_picture{480, 640};

bool make_context() {
  setenv("LP_NUM_THREADS", "0", 1);  // llvmpipe draws in the calling thread
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  const auto get_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (!get_display) return false;
  const EGLDisplay display = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API))
    return false;
  const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_DEPTH_SIZE, 24,
                           EGL_NONE};
  EGLConfig config;
  EGLint found = 0;
  if (!eglChooseConfig(display, wanted, &config, 1, &found) || !found) return false;
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
  return context != EGL_NO_CONTEXT && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
}

void draw(benchmark::State& state, bool shadow, Size size) {
  const auto [rows, columns] = size;
  static const bool drawable = make_context();
  if (!drawable) return state.SkipWithError("no software OpenGL here");
  BareMujoco& bare = first_scene();
  bare.model()->vis.quality.offsamples = 0;    // no antialiasing
  bare.model()->vis.quality.shadowsize = 512;  // texels enough for this picture; its default is 4096
  mjrContext context;
  mjr_defaultContext(&context);
  mjr_makeContext(bare.model(), &context, mjFONTSCALE_100);
  mjr_setBuffer(mjFB_OFFSCREEN, &context);
  mjvScene scene;
  mjv_defaultScene(&scene);
  mjv_makeScene(bare.model(), &scene, 100);
  mjvOption option;
  mjv_defaultOption(&option);
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  camera.lookat[0] = .5;
  camera.elevation = -90;
  camera.distance = 1;
  std::vector<unsigned char> picture(static_cast<std::size_t>(rows * columns * 3));
  const mjrRect all{0, 0, columns, rows};
  bare.reset();
  const auto render = [&] {
    mjv_updateScene(bare.model(), bare.data(), &option, nullptr, &camera, mjCAT_ALL, &scene);
    scene.flags[mjRND_REFLECTION] = scene.flags[mjRND_SKYBOX] = 0;
    for (const bool ids : {false, true}) {
      scene.flags[mjRND_SHADOW] = shadow && !ids;
      scene.flags[mjRND_SEGMENT] = scene.flags[mjRND_IDCOLOR] = ids;
      mjr_render(all, &scene, &context);
      mjr_readPixels(picture.data(), nullptr, all, &context);
    }
  };
  render();  // compiles its shaders
  if (std::count(picture.begin(), picture.end(), picture[0]) == static_cast<std::ptrdiff_t>(picture.size()))
    stop_at("the picture by llvmpipe shows nothing");
  for (auto _ : state) {
    render();
    benchmark::DoNotOptimize(picture.data());
  }
  mjv_freeScene(&scene);
  mjr_freeContext(&context);
}

}  // namespace

void register_llvmpipe() {
  benchmark::RegisterBenchmark("picture/llvmpipe", draw, false, tabletop_picture);
  benchmark::RegisterBenchmark("picture/llvmpipe_shadow", draw, true, tabletop_picture);
  benchmark::RegisterBenchmark("picture/mobile/llvmpipe_shadow", draw, true, mobile_picture);
}

}  // namespace lgabench
