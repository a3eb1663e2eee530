// glint completion: prints a script that completes glint's command line in a shell.
#include "cli/completion.h"

#include "cli/command_line.h"
#include "cli/commands.h"

#include <memory>
#include <string>

namespace glint {

void addCompletion(CLI::App& app, Action& chosen) {
    auto shell = std::make_shared<std::string>();
    CLI::App& command =
        addCommand(app, "completion", "Print a script that completes this command line in a shell",
                   "glint completion bash > ~/.local/share/bash-completion/completions/glint");
    addChoice(command, "SHELL", *shell, {"bash", "zsh", "fish"}, "the shell").required();
    command.callback([shell, &app, &chosen] {
        chosen = [shell, &app](const Console& console) {
            const std::vector<CommandModel> commands = describeCommands(app);
            console.print(*shell == "bash"  ? bashCompletion(commands)
                          : *shell == "zsh" ? zshCompletion(commands)
                                            : fishCompletion(commands));
            return kExitDone;
        };
    });
}

}  // namespace glint
