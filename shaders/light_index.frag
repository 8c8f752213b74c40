// Into the light index images, through whatever blending the packing has.
flat in vec4 channels[LIDR_TARGETS];

layout(location = 0) out vec4 images[LIDR_TARGETS];

void main() { images = channels; }
