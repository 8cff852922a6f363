#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace plisse {

/// What a run of the program ended with.
struct Outcome {
    int code = -1; ///< exit code; minus the signal when one ended it
    std::string out, err;
};

/// The built program, running with these arguments in a folder where its output is kept.
class Program {
public:
    Program(const std::filesystem::path& folder, const std::vector<std::string>& arguments)
        : out_(folder / "stdout.txt"), err_(folder / "stderr.txt") {
        std::vector<std::string> words{PLISSE_PROGRAM};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> argv;
        for (std::string& word : words)
            argv.push_back(word.data());
        argv.push_back(nullptr);
        process_ = fork();
        if (process_ == 0) {
            redirect(out_, STDOUT_FILENO);
            redirect(err_, STDERR_FILENO);
            execv(argv[0], argv.data());
            _exit(127);
        }
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    void send(int signal) const { kill(process_, signal); }

    Outcome wait() {
        int status = 0;
        waitpid(process_, &status, 0);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), text_of(out_), text_of(err_)};
    }

private:
    static void redirect(const std::filesystem::path& file, int descriptor) {
        std::FILE* stream = std::fopen(file.c_str(), "wb");
        dup2(fileno(stream), descriptor);
    }
    static std::string text_of(const std::filesystem::path& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    std::filesystem::path out_, err_;
    pid_t process_ = -1;
};

} // namespace plisse
