#include "view/x11/desktop.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <thread>
#include <vector>

namespace lightgrid::app {
namespace {

using Clock = std::chrono::steady_clock;

// Calls done() every hundredth of a second until it is true.
template <typename Done>
bool within(double seconds, const Done& done) {
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (!done()) {
    if (Clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

// Returns the first with such a title among `window` and the windows in it.
Window titled(Display* x, Window window, const std::string& title) {
  char* name = nullptr;
  const bool found = XFetchName(x, window, &name) && std::string(name).starts_with(title);
  if (name) XFree(name);
  if (found) return window;
  Window root = 0, parent = 0, *children = nullptr, inner = 0;
  unsigned count = 0;
  if (!XQueryTree(x, window, &root, &parent, &children, &count)) return 0;
  for (unsigned i = 0; i < count && !inner; ++i) inner = titled(x, children[i], title);
  if (children) XFree(children);
  return inner;
}

}  // namespace

struct Desktop::Parts {
  std::FILE* server = nullptr;
  int pid = 0, number = -1;
  Display* x = nullptr;
  Window window = 0;

  Atom atom(const char* name) { return XInternAtom(x, name, False); }

  XWindowAttributes attributes() {
    XWindowAttributes now{};
    XGetWindowAttributes(x, window, &now);
    return now;
  }

  // GLFW drops a key that went down at the time of the one before.
  Time next_time() { return ++time_; }

  void send(XEvent event, long mask) {
    XSendEvent(x, window, True, mask, &event);
    XFlush(x);
  }

  // Fills the fields that key, button and pointer events have in common.
  template <typename Event>
  Event at(int type, int px, int py) {
    Event event{};
    event.type = type;
    event.display = x;
    event.window = window;
    event.root = DefaultRootWindow(x);
    event.time = next_time();
    event.x = px;
    event.y = py;
    event.same_screen = True;
    return event;
  }

  // A window that asks for the clipboard's text.
  Window ask_for_clipboard(Display* by) {
    const Window asking = XCreateSimpleWindow(by, DefaultRootWindow(by), 0, 0, 1, 1, 0, 0, 0);
    XConvertSelection(by, XInternAtom(by, "CLIPBOARD", False), XInternAtom(by, "UTF8_STRING", False),
                      XInternAtom(by, "LIGHTGRID_TEXT", False), asking, CurrentTime);
    XFlush(by);
    return asking;
  }

 private:
  Time time_ = 1000;
};

// Its first line is the process, its second the number of the display that it chose.
Desktop::Desktop() : parts_(std::make_unique<Parts>()) {
  parts_->server =
      popen("echo $$; exec Xvfb -displayfd 1 -screen 0 1280x1024x24 -nolisten tcp 2>/dev/null", "r");
  if (!parts_->server) return;
  if (std::fscanf(parts_->server, "%d %d", &parts_->pid, &parts_->number) != 2) return;
  parts_->x = XOpenDisplay(name().c_str());
  // A picture may be asked for while the window's size changes: no reason to end.
  XSetErrorHandler([](Display*, XErrorEvent*) { return 0; });
}

Desktop::~Desktop() {
  if (parts_->x) XCloseDisplay(parts_->x);
  if (parts_->pid > 0) kill(parts_->pid, SIGTERM);
  if (parts_->server) pclose(parts_->server);
}

bool Desktop::runs() const { return parts_->x != nullptr; }

std::string Desktop::name() const { return ":" + std::to_string(parts_->number); }

bool Desktop::find_window(const std::string& title, double seconds) {
  return within(seconds, [&] {
    parts_->window = titled(parts_->x, DefaultRootWindow(parts_->x), title);
    return parts_->window && parts_->attributes().map_state == IsViewable;
  });
}

void Desktop::resize(int width, int height) {
  XResizeWindow(parts_->x, parts_->window, unsigned(width), unsigned(height));
  XSync(parts_->x, False);
}

PngPixels Desktop::picture() {
  const XWindowAttributes now = parts_->attributes();
  XImage* image = XGetImage(parts_->x, parts_->window, 0, 0, unsigned(now.width), unsigned(now.height),
                            AllPlanes, ZPixmap);
  if (!image) return {};
  PngPixels pixels{image->width, image->height, {}};
  pixels.rgb.reserve(size_t(image->width) * size_t(image->height) * 3);
  for (int y = 0; y < image->height; ++y) {
    for (int x = 0; x < image->width; ++x) {
      const unsigned long colour = XGetPixel(image, x, y);
      for (const int shift : {16, 8, 0}) pixels.rgb.push_back(uint8_t(colour >> shift));
    }
  }
  XDestroyImage(image);
  return pixels;
}

void Desktop::key(const std::string& name, bool down) {
  XEvent event{};
  event.xkey = parts_->at<XKeyEvent>(down ? KeyPress : KeyRelease, 0, 0);
  event.xkey.keycode = XKeysymToKeycode(parts_->x, XStringToKeysym(name.c_str()));
  parts_->send(event, down ? KeyPressMask : KeyReleaseMask);
}

void Desktop::point(int x, int y) {
  XEvent event{};
  event.xmotion = parts_->at<XMotionEvent>(MotionNotify, x, y);
  parts_->send(event, PointerMotionMask);
}

void Desktop::button(bool down, int x, int y) {
  XEvent event{};
  event.xbutton = parts_->at<XButtonEvent>(down ? ButtonPress : ButtonRelease, x, y);
  event.xbutton.button = Button1;
  parts_->send(event, down ? ButtonPressMask : ButtonReleaseMask);
}

bool Desktop::drop(const std::string& path, double seconds) {
  Display* x = parts_->x;
  const Atom list = parts_->atom("text/uri-list"), selection = parts_->atom("XdndSelection");
  const Window source = XCreateSimpleWindow(x, DefaultRootWindow(x), 0, 0, 1, 1, 0, 0, 0);
  XSetSelectionOwner(x, selection, source, CurrentTime);
  const auto tell = [&](const char* message, long second, long third) {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = parts_->window;
    event.xclient.message_type = parts_->atom(message);
    event.xclient.format = 32;
    event.xclient.data.l[0] = long(source);
    event.xclient.data.l[1] = second;
    event.xclient.data.l[2] = third;
    parts_->send(event, NoEventMask);
  };
  tell("XdndEnter", 5L << 24, long(list));
  tell("XdndPosition", 0, 50 << 16 | 50);
  tell("XdndDrop", 0, CurrentTime);
  XEvent asked{};
  const bool fetched =
      within(seconds, [&] { return XCheckTypedWindowEvent(x, source, SelectionRequest, &asked); });
  if (fetched) {
    const std::string text = "file://" + path + "\r\n";
    const XSelectionRequestEvent& request = asked.xselectionrequest;
    XChangeProperty(x, request.requestor, request.property, request.target, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(text.data()), int(text.size()));
    XEvent answer{};
    answer.xselection.type = SelectionNotify;
    answer.xselection.requestor = request.requestor;
    answer.xselection.selection = request.selection;
    answer.xselection.target = request.target;
    answer.xselection.property = request.property;
    XSendEvent(x, request.requestor, False, NoEventMask, &answer);
    XSync(x, False);
  }
  XDestroyWindow(x, source);
  return fetched;
}

std::optional<std::string> Desktop::clipboard(double seconds) {
  Display* x = parts_->x;
  const Window asking = parts_->ask_for_clipboard(x);
  XEvent event{};
  std::optional<std::string> text;
  if (within(seconds, [&] { return XCheckTypedWindowEvent(x, asking, SelectionNotify, &event); }) &&
      event.xselection.property != None) {
    Atom type = 0;
    int bits = 0;
    unsigned long count = 0, left = 0;
    unsigned char* bytes = nullptr;
    XGetWindowProperty(x, asking, event.xselection.property, 0, 1 << 16, True, AnyPropertyType, &type, &bits,
                       &count, &left, &bytes);
    if (bytes) text = std::string(reinterpret_cast<char*>(bytes), count);
    if (bytes) XFree(bytes);
  }
  XDestroyWindow(x, asking);
  return text;
}

void Desktop::want_clipboard_and_leave() {
  Display* other = XOpenDisplay(name().c_str());
  parts_->ask_for_clipboard(other);
  XSync(other, False);
  XCloseDisplay(other);
}

void Desktop::close() {
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = parts_->window;
  event.xclient.message_type = parts_->atom("WM_PROTOCOLS");
  event.xclient.format = 32;
  event.xclient.data.l[0] = long(parts_->atom("WM_DELETE_WINDOW"));
  event.xclient.data.l[1] = CurrentTime;
  parts_->send(event, NoEventMask);
}

}  // namespace lightgrid::app
