#include "view/virtual_screen.h"

#include <array>
#include <csignal>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace glint::testing {

VirtualScreen::VirtualScreen() {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) {
        return;
    }
    const std::string number = std::to_string(ends[1]);
    child_ = fork();
    if (child_ == 0) {
        prctl(PR_SET_PDEATHSIG, SIGTERM);
        close(ends[0]);
        const int nothing = open("/dev/null", O_RDWR);
        dup2(nothing, STDOUT_FILENO);
        dup2(nothing, STDERR_FILENO);
        execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "1280x1000x24", "-nolisten",
               "tcp", nullptr);
        _exit(127);
    }
    close(ends[1]);
    // The server writes its number and a line break, in two parts, when it is ready.
    std::string text;
    for (char c = '\0'; read(ends[0], &c, 1) == 1 && c != '\n';) {
        text += c;
    }
    close(ends[0]);
    display_ = text.empty() ? "" : ":" + text;
}

VirtualScreen::~VirtualScreen() {
    if (child_ > 0) {
        kill(child_, SIGTERM);
        waitpid(child_, nullptr, 0);
    }
}

}  // namespace glint::testing
