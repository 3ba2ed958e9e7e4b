// SPDX-License-Identifier: Apache-2.0
#include "balls/set_cover.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/parallel.hpp"
#include "base/random.hpp"

namespace scaleaxis {
namespace {

// The sets of each element.
IndexLists transposed(const SetSystem& system) {
    IndexLists lists;
    lists.offsets.assign(static_cast<std::size_t>(system.elements) + 1, 0);
    for (const Index element : system.sets.items) {
        ++lists.offsets[element + 1];
    }
    std::partial_sum(lists.offsets.begin(), lists.offsets.end(), lists.offsets.begin());
    lists.items.resize(system.sets.items.size());
    std::vector<Index> next(lists.offsets.begin(), lists.offsets.end() - 1);
    for (std::size_t set = 0; set < system.sets.size(); ++set) {
        for (const Index element : system.sets[set]) {
            lists.items[next[element]++] = static_cast<Index>(set);
        }
    }
    return lists;
}

std::vector<Index> without_redundant(const SetSystem& system, std::vector<Index> cover) {
    std::vector<Index> times(system.elements, 0);
    for (const Index set : cover) {
        for (const Index element : system.sets[set]) {
            ++times[element];
        }
    }
    std::vector<Index> order = cover;
    std::ranges::stable_sort(order, {}, [&](Index set) { return system.sets[set].size(); });
    for (const Index set : order) {
        const auto elements = system.sets[set];
        if (std::ranges::all_of(elements, [&](Index element) { return times[element] > 1; })) {
            std::ranges::for_each(elements, [&](Index element) { --times[element]; });
            std::erase(cover, set);
        }
    }
    return cover;
}

}  // namespace

std::optional<std::vector<Index>> greedy_cover(const SetSystem& system, Index limit) {
    const IndexLists sets_of = transposed(system);
    std::vector<Index> gains(system.sets.size());
    for (std::size_t set = 0; set < gains.size(); ++set) {
        gains[set] = static_cast<Index>(system.sets[set].size());
    }
    std::vector<char> is_covered(system.elements, 0);
    std::vector<Index> cover;
    for (Index left = system.elements; left > 0;) {
        stop_if_cancelled();
        const auto best = std::ranges::max_element(gains);
        if (best == gains.end() || *best == 0) {
            return std::nullopt;
        }
        const auto set = static_cast<Index>(best - gains.begin());
        cover.push_back(set);
        left -= *best;
        for (const Index element : system.sets[set]) {
            if (is_covered[element] == 0) {
                is_covered[element] = 1;
                for (const Index other : sets_of[element]) {
                    --gains[other];
                }
            }
        }
        // What is dropped in the end is a few in a hundred.
        if (static_cast<Index>(cover.size()) > limit + limit / 2 + 8) {
            return std::nullopt;
        }
    }
    cover = without_redundant(system, std::move(cover));
    return static_cast<Index>(cover.size()) <= limit ? std::optional(cover) : std::nullopt;
}

namespace {

// What the local search knows of its sets and elements.
class RowWeighting {
   public:
    RowWeighting(const SetSystem& system, std::vector<Index> chosen)
        : system_(system),
          sets_of_(transposed(system)),
          chosen_(std::move(chosen)),
          weights_(system.elements, 1),
          times_(system.elements, 0),
          position_(system.elements, kNone),
          scores_(system.sets.size(), 0),
          changed_(system.sets.size(), 0),
          is_chosen_(system.sets.size(), 0) {
        for (const Index set : chosen_) {
            is_chosen_[set] = 1;
            for (const Index element : system_.sets[set]) {
                ++times_[element];
            }
        }
        for (Index element = 0; element < system_.elements; ++element) {
            if (times_[element] == 0) {
                set_uncovered(element);
            }
            for (const Index set : sets_of_[element]) {
                scores_[set] += times_[element] == is_chosen_[set] ? 1 : 0;
            }
        }
    }

    // Until a cover is found or the work is done.
    bool run(std::int64_t work) {
        for (std::int64_t step = 1; !uncovered_.empty(); ++step) {
            stop_if_cancelled();
            if (work_ > work || chosen_.size() < 2) {
                return false;
            }
            const Index gone = remove_least(step);
            const Index element = uncovered_[random_bits(1, static_cast<std::uint64_t>(step)) % uncovered_.size()];
            add_best(element, gone, step);
            for (const Index left : uncovered_) {
                ++weights_[left];
                for (const Index set : sets_of_[left]) {
                    ++scores_[set];
                }
                work_ += static_cast<std::int64_t>(sets_of_[left].size());
            }
        }
        return true;
    }

    const std::vector<Index>& chosen() const { return chosen_; }

   private:
    void set_uncovered(Index element) {
        position_[element] = static_cast<Index>(uncovered_.size());
        uncovered_.push_back(element);
    }
    void set_covered(Index element) {
        uncovered_[position_[element]] = uncovered_.back();
        position_[uncovered_.back()] = position_[element];
        uncovered_.pop_back();
    }

    Index remove_least(std::int64_t step) {
        std::size_t least = chosen_.size();
        for (std::size_t k = 0; k < chosen_.size(); ++k) {
            const Index set = chosen_[k];
            if (set == added_last_) {
                continue;
            }
            if (least == chosen_.size() || scores_[set] < scores_[chosen_[least]] ||
                (scores_[set] == scores_[chosen_[least]] && changed_[set] < changed_[chosen_[least]])) {
                least = k;
            }
        }
        const Index gone = chosen_[least];
        chosen_[least] = chosen_.back();
        chosen_.pop_back();
        is_chosen_[gone] = 0;
        changed_[gone] = step;
        for (const Index element : system_.sets[gone]) {
            const std::int64_t weight = weights_[element];
            if (--times_[element] == 0) {
                set_uncovered(element);
                for (const Index set : sets_of_[element]) {
                    scores_[set] += set == gone ? 0 : weight;  // its loss becomes its gain
                }
                work_ += static_cast<std::int64_t>(sets_of_[element].size());
            } else if (times_[element] == 1) {
                for (const Index set : sets_of_[element]) {
                    scores_[set] += is_chosen_[set] != 0 ? weight : 0;
                }
                work_ += static_cast<std::int64_t>(sets_of_[element].size());
            }
        }
        return gone;
    }

    void add_best(Index element, Index gone, std::int64_t step) {
        Index best = kNone;
        for (const Index set : sets_of_[element]) {
            if (set == gone) {
                continue;
            }
            if (best == kNone || scores_[set] > scores_[best] ||
                (scores_[set] == scores_[best] && changed_[set] < changed_[best])) {
                best = set;
            }
        }
        if (best == kNone) {
            best = gone;
        }
        chosen_.push_back(best);
        is_chosen_[best] = 1;
        changed_[best] = step;
        added_last_ = best;
        for (const Index each : system_.sets[best]) {
            const std::int64_t weight = weights_[each];
            if (++times_[each] == 1) {
                set_covered(each);
                for (const Index set : sets_of_[each]) {
                    scores_[set] -= set == best ? 0 : weight;
                }
                work_ += static_cast<std::int64_t>(sets_of_[each].size());
            } else if (times_[each] == 2) {
                for (const Index set : sets_of_[each]) {
                    scores_[set] -= is_chosen_[set] != 0 && set != best ? weight : 0;
                }
                work_ += static_cast<std::int64_t>(sets_of_[each].size());
            }
        }
    }

    const SetSystem& system_;
    IndexLists sets_of_;
    std::vector<Index> chosen_;
    std::vector<std::int64_t> weights_;
    std::vector<Index> times_;           // how many of the chosen sets each element is in
    std::vector<Index> position_;        // in `uncovered_`
    std::vector<std::int64_t> scores_;   // by how much the weight of what is covered changes with the set
    std::vector<std::int64_t> changed_;  // step at which a set came or went
    std::vector<Index> is_chosen_;
    std::vector<Index> uncovered_;
    Index added_last_ = kNone;
    std::int64_t work_ = 0;
};

}  // namespace

std::optional<std::vector<Index>> cover_of_size(const SetSystem& system, std::vector<Index> chosen, std::int64_t work) {
    RowWeighting search(system, std::move(chosen));
    return search.run(work) ? std::optional(search.chosen()) : std::nullopt;
}

Index cover_bound(const SetSystem& system, Index cover) {
    constexpr int kIterations = 400;
    constexpr int kPatience = 15;
    const std::size_t sets = system.sets.size();
    // Each element pays for the largest set that it is in: a set never costs more than 1.
    std::vector<double> prices(system.elements, 1.0);
    for (std::size_t set = 0; set < sets; ++set) {
        for (const Index element : system.sets[set]) {
            prices[element] = std::min(prices[element], 1.0 / static_cast<double>(system.sets[set].size()));
        }
    }
    std::vector<Index> times(system.elements);
    double best = 0.0;
    double step = 1.0;
    int failures = 0;
    for (int i = 0; i < kIterations && step > 0.005; ++i) {
        stop_if_cancelled();
        double value = std::accumulate(prices.begin(), prices.end(), 0.0);
        std::ranges::fill(times, 0);
        for (std::size_t set = 0; set < sets; ++set) {
            double cost = 1.0;
            for (const Index element : system.sets[set]) {
                cost -= prices[element];
            }
            if (cost < 0.0) {
                value += cost;
                for (const Index element : system.sets[set]) {
                    ++times[element];
                }
            }
        }
        if (value > best) {
            best = value;
            failures = 0;
        } else if (++failures == kPatience) {
            failures = 0;
            step *= 0.5;
        }
        double square = 0.0;
        for (const Index count : times) {
            square += (1.0 - count) * (1.0 - count);
        }
        if (square == 0.0) {
            break;  // the relaxation is a cover
        }
        const double length = step * std::max(1.0, 1.02 * cover - value) / square;
        for (Index element = 0; element < system.elements; ++element) {
            prices[element] = std::max(0.0, prices[element] + length * (1.0 - times[element]));
        }
    }
    return static_cast<Index>(std::ceil(best - 1e-6));
}

}  // namespace scaleaxis
