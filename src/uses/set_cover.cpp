// SPDX-License-Identifier: Apache-2.0
#include "uses/set_cover.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/grouped.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"

namespace scaleaxis::inline v1 {
namespace {

// In which of the lists that are left each item is; ascending.
IndexLists transposed(const IndexLists& lists, std::size_t items, const std::vector<char>& is_left) {
    return grouped(items, [&](const auto& add) {
        for (std::size_t list = 0; list < lists.size(); ++list) {
            if (is_left[list] != 0) {
                std::ranges::for_each(lists[list], [&](Index item) { add(item, static_cast<Index>(list)); });
            }
        }
    });
}

IndexLists sets_of_elements(const SetSystem& system) {
    return transposed(system.sets, system.elements, std::vector<char>(system.sets.size(), 1));
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
    const IndexLists sets_of = sets_of_elements(system);
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

// Does the first of two lists, which ascend, have all that the other one has, which is not empty?
bool has_all(std::span<const Index> list, std::span<const Index> other) {
    return list.size() >= other.size() && list.front() <= other.front() && list.back() >= other.back() &&
           std::ranges::includes(list, other);
}

// Of the lists that have all that one of them has, calls `visit` for those that are left, until it returns true.
template <class Visit>
void for_each_that_has_all(const IndexLists& lists, const IndexLists& lists_of, Index one,
                           const std::vector<char>& is_left, const Visit& visit) {
    const Index rarest = *std::ranges::min_element(lists[one], {}, [&](Index item) { return lists_of[item].size(); });
    for (const Index other : lists_of[rarest]) {
        if (other != one && is_left[other] != 0 && has_all(lists[other], lists[one]) && visit(other)) {
            return;
        }
    }
}

// A system that has the same covers as far as they matter: without sets all of whose elements another set has too, and
// without elements that are in each of the sets that another element is in.
struct Reduced {
    SetSystem system;
    std::vector<Index> sets;     // as they were
    std::vector<Index> instead;  // for each set as it was: the one left that has its elements; kNone: it has none
};

// \param whole each element is in a set
Reduced reduced(const SetSystem& whole) {
    std::vector<Index> instead(whole.sets.size());
    std::iota(instead.begin(), instead.end(), 0);
    std::vector<char> is_set_left(whole.sets.size(), 1);
    std::vector<char> is_element_left(whole.elements, 1);
    IndexLists sets_of = sets_of_elements(whole);
    IndexLists elements_of = transposed(sets_of, whole.sets.size(), is_element_left);
    std::size_t before = 0;
    do {
        stop_if_cancelled();
        before = elements_of.items.size();
        for (Index set = 0; set < static_cast<Index>(elements_of.size()); ++set) {
            if (elements_of[set].empty()) {
                is_set_left[set] = 0;
            } else if (is_set_left[set] != 0) {
                for_each_that_has_all(elements_of, sets_of, set, is_set_left, [&](Index other) {
                    instead[set] = other;
                    is_set_left[set] = 0;
                    return true;
                });
            }
        }
        sets_of = transposed(elements_of, sets_of.size(), is_set_left);
        for (Index element = 0; element < whole.elements; ++element) {
            if (is_element_left[element] != 0) {
                for_each_that_has_all(sets_of, elements_of, element, is_element_left, [&](Index other) {
                    is_element_left[other] = 0;
                    return false;
                });
            }
        }
        elements_of = transposed(sets_of, elements_of.size(), is_element_left);
        sets_of = transposed(elements_of, sets_of.size(), is_set_left);
    } while (elements_of.items.size() != before);

    Reduced result;
    std::vector<Index> number(whole.elements, kNone);
    for (Index element = 0; element < whole.elements; ++element) {
        number[element] = is_element_left[element] != 0 ? result.system.elements++ : kNone;
    }
    std::vector<Index> place(whole.sets.size(), kNone);
    for (std::size_t set = 0; set < elements_of.size(); ++set) {
        if (is_set_left[set] != 0) {
            place[set] = static_cast<Index>(result.sets.size());
            result.sets.push_back(static_cast<Index>(set));
            std::vector<Index> elements(elements_of[set].begin(), elements_of[set].end());
            std::ranges::transform(elements, elements.begin(), [&](Index element) { return number[element]; });
            result.system.sets.push_back(elements);
        }
    }
    for (Index set : instead) {
        while (instead[set] != set) {
            set = instead[set];
        }
        result.instead.push_back(place[set]);
    }
    return result;
}

// What the local search knows of its sets and elements.
class RowWeighting {
   public:
    RowWeighting(const SetSystem& system, std::vector<Index> chosen)
        : system_(system),
          sets_of_(sets_of_elements(system)),
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

    // Sets are added until they are so many, or a cover.
    void fill(std::size_t count) {
        while (chosen_.size() < count && !uncovered_.empty()) {
            add_best(uncovered_.front(), kNone, 0);
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
        constexpr std::int64_t kStep = 100;  // what a step takes otherwise
        work_ += static_cast<std::int64_t>(chosen_.size()) + kStep;
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

std::optional<std::vector<Index>> cover_of_size(const SetSystem& system, const std::vector<Index>& chosen,
                                                std::int64_t work) {
    const IndexLists sets_of = sets_of_elements(system);
    for (Index element = 0; element < system.elements; ++element) {
        if (sets_of[element].empty()) {
            return std::nullopt;
        }
    }
    const Reduced small = reduced(system);
    std::vector<Index> start;
    for (const Index set : chosen) {
        if (small.instead[set] != kNone && std::ranges::find(start, small.instead[set]) == start.end()) {
            start.push_back(small.instead[set]);
        }
    }
    RowWeighting search(small.system, std::move(start));
    search.fill(chosen.size());
    if (!search.run(work)) {
        return std::nullopt;
    }
    std::vector<Index> cover;
    std::ranges::transform(search.chosen(), std::back_inserter(cover), [&](Index set) { return small.sets[set]; });
    for (auto set = chosen.begin(); cover.size() < chosen.size(); ++set) {
        if (std::ranges::find(cover, *set) == cover.end()) {
            cover.push_back(*set);
        }
    }
    return cover;
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

}  // namespace scaleaxis::inline v1
