// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <iterator>
#include <list>
#include <utility>

namespace shutter::graph {

/// Objects by key, cached from round to round for reuse. One key may have several: a round uses
/// each object once. Addresses stay until dropIdle() or clear().
template <class Key, class Object> class KeptObjects {
  public:
    /// All objects become idle.
    void beginRound() { ++mRound; }

    /// An idle object of this key, which this round now uses; null: make one and add() it.
    [[nodiscard]] Object* use(const Key& key) {
        for (Entry& entry : mEntries)
            if (entry.lastRound != mRound && entry.key == key) {
                entry.lastRound = mRound;
                return &entry.object;
            }
        return nullptr;
    }

    /// Adds an object, which this round uses.
    Object* add(const Key& key, Object object) {
        mEntries.push_back({key, std::move(object), mRound});
        return &mEntries.back().object;
    }

    /// Drops idle objects, those unused for longest first, until the rest of them costs no more
    /// than `most`.
    /// \param cost of a key's object
    template <class Cost> void dropIdle(uint64_t most, Cost cost) {
        uint64_t idle = 0;
        for (const Entry& entry : mEntries)
            if (entry.lastRound != mRound)
                idle += cost(entry.key);
        while (idle > most) {
            const auto oldest = findOldest();
            idle -= cost(oldest->key);
            mEntries.erase(oldest);
        }
    }

    /// Drops objects not used in the last `rounds` rounds.
    void dropUnused(uint64_t rounds) {
        mEntries.remove_if([&](const Entry& entry) { return entry.lastRound + rounds < mRound; });
    }

    void clear() { mEntries.clear(); }

    /// The sum of the costs of all objects, used or idle.
    template <class Cost> [[nodiscard]] uint64_t sum(Cost cost) const {
        uint64_t total = 0;
        for (const Entry& entry : mEntries)
            total += cost(entry.key);
        return total;
    }

  private:
    struct Entry {
        Key key;
        Object object;
        uint64_t lastRound = 0;
    };

    /// The first of those unused for longest; there is an idle one whenever this is called.
    [[nodiscard]] typename std::list<Entry>::iterator findOldest() {
        auto oldest = mEntries.begin();
        for (auto entry = std::next(oldest); entry != mEntries.end(); ++entry)
            if (entry->lastRound < oldest->lastRound)
                oldest = entry;
        return oldest;
    }

    std::list<Entry> mEntries; ///< not a vector: addresses of elements must not change
    uint64_t mRound = 0;
};

} // namespace shutter::graph
