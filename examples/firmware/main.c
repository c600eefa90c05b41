/** The controller on a board: one step for each message of the plant, over two pipes on the host. */
#include "controller.h"
#include "semihosting.h"

static float given[sizeof(controller_input_t) / sizeof(float)];
static float result[sizeof(controller_output_t) / sizeof(float)];

int main(void)
{
    const int32_t from = semihosting_open("measured", 8, 1);
    const int32_t to = semihosting_open("commanded", 9, 5);
    if (from < 0 || to < 0) {
        return 71;
    }
    while (semihosting_read(from, given, sizeof given) == 0) {
        (void)controller_step(given, result);
        if (semihosting_write(to, result, sizeof result) != 0) {
            return 73;
        }
    }
    return 0;
}
