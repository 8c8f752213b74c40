// A display of its own (Xvfb) with one window, and a user in front of it: keys, the pointer, the window's
// size, the clipboard, and what the screen shows. Events are sent by another program than the window's; GLFW
// takes them as those of a keyboard and a mouse.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "support/png_pixels.h"

namespace lightgrid::app {

class Desktop {
 public:
  Desktop();  // starts the display; runs() is false where there is no Xvfb
  ~Desktop();
  Desktop(const Desktop&) = delete;

  bool runs() const;
  std::string name() const;  // the value of DISPLAY

  // Waits for a window whose title starts so. The functions below are about this window. Positions are pixels
  // from its upper left.
  bool find_window(const std::string& title, double seconds);

  void resize(int width, int height);
  PngPixels picture();  // the screen's picture; empty while the size is about to change

  void key(const std::string& name, bool down);  // X11's name: "w", "space", "F12"
  void tap(const std::string& name) {
    key(name, true);
    key(name, false);
  }
  void point(int x, int y);
  void button(bool down, int x, int y);
  void click(int x, int y) {
    point(x, y);
    button(true, x, y);
    button(false, x, y);
  }

  // Drops a file as a file manager does (XDND). Returns whether the window's program fetched its name.
  bool drop(const std::string& path, double seconds);

  std::optional<std::string> clipboard(double seconds);  // text that the window's program answers with
  // Another program wants the clipboard's text and ends before it has it.
  void want_clipboard_and_leave();

  void close();  // as the frame's button does

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace lightgrid::app
