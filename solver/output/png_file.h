/* png_file.h - pixels to a PNG file.
 * SPDX-License-Identifier: MIT */
#ifndef PNG_FILE_H
#define PNG_FILE_H

#include <stdint.h>

/* rgb: [height * width * 3], sRGB, from the top left. The file appears whole or not at all.
 * Returns 0, or -1 after a message. */
int png_file_write(const char *path, int width, int height, const uint8_t *rgb);

#endif
