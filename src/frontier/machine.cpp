#include "frontier/machine.h"

#include <cstdlib>
#include <fstream>

namespace lightgrid {
namespace {

std::string first_line(const char* path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

// The value of the first line "KEY : VALUE" of /proc/cpuinfo.
std::string cpu_info(const std::string& key) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const size_t colon = line.find(':');
    if (line.starts_with(key) && colon != std::string::npos && colon + 2 <= line.size())
      return line.substr(colon + 2);
  }
  return "";
}

}  // namespace

double load_average() {
  double loads[1] = {0};
  return getloadavg(loads, 1) == 1 ? loads[0] : 0;
}

FrontierMachine machine_of(const Renderer& renderer) {
  FrontierMachine m;
  const ClDeviceInfo& device = renderer.cl->info();
  m.cl_device = device.name, m.cl_driver = device.platform + " " + device.driver;
  m.gl_device = renderer.gl ? renderer.gl->renderer : "none";
  m.gl_driver = renderer.gl ? renderer.gl->version : "none";
  m.cpu = cpu_info("model name");
  const std::string governor = first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  m.governor = governor.empty() ? "unknown" : governor;
  m.clock_mhz = std::atof(cpu_info("cpu MHz").c_str());
  m.threads = device.compute_units;
  m.load_at_start = m.load_at_end = load_average();
  return m;
}

}  // namespace lightgrid
