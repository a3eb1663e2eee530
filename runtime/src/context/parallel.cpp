#include "context/parallel.h"

#include <new>
#include <utility>

namespace glint {

Diagnostic caughtError() {
    try {
        throw;
    } catch (const std::bad_alloc&) {
        // These texts fit into std::string itself, since there is no memory.
        Diagnostic error = makeError("memory-host", "", "no memory left");
        error.kind = ErrorKind::OutOfHostMemory;
        return error;
    } catch (const std::system_error& failure) {
        return makeError("threads", "", std::string("the system gives no thread: ") + failure.what(),
                         "raise the limit of threads of the process");
    } catch (const std::exception& failure) {
        return makeError("exception", "", failure.what());
    }
}

Jobs::~Jobs() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) {
        thread.join();
    }
}

void Jobs::run(std::function<void()> job) {
    if (run_) {
        run_(std::move(job));
        return;
    }
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(job));
    if (waiting_.size() > idle_) {
        try {
            threads_.emplace_back([this] { work(); });
        } catch (...) {
            if (threads_.empty()) {
                waiting_.pop_back();
                throw;
            }
        }
    }
    changed_.notify_one();
}

void Jobs::report(const Diagnostic& message) const {
    if (message_) {
        message_(message);
    }
}

void Jobs::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        ++idle_;
        changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
        --idle_;
        if (waiting_.empty()) {
            return;
        }
        std::function<void()> job = std::move(waiting_.front());
        waiting_.pop_front();
        lock.unlock();
        job();
        job = nullptr;
        lock.lock();
    }
}

JobGroup::~JobGroup() {
    std::unique_lock lock(shared_->mutex);
    shared_->ends = true;
    shared_->changed.wait(lock, [this] { return shared_->running == 0; });
}

void JobGroup::run(std::function<void()> job) {
    jobs_->run([shared = shared_, job = std::move(job)] {
        {
            const std::lock_guard lock(shared->mutex);
            if (shared->ends) {
                return;
            }
            ++shared->running;
        }
        job();
        const std::lock_guard lock(shared->mutex);
        --shared->running;
        shared->changed.notify_all();
    });
}

}  // namespace glint
