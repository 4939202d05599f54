// The block in a simulation that another program drives over pipes: register accesses, lines of pixels and
// records, with random pauses on both streams.
//
// Commands on standard input, numbers with their lowest byte first; answers on standard output:
//
//   'W' u8 offset, u32 value             writes a register
//   'R' u8 offset                        reads one: u32
//   'P' u32 seed, u8 gaps, u8 stalls     pauses from here on: percent of clocks without a pixel, and without
//                                        taking a record; after one line in eight a longer pause
//   'L' u8 marks, u32 count, pixels      queues a line, two bytes a pixel, left and right; marks: 1 begins a
//                                        frame, 2 ends the line
//   'T' u32 count, u32 clocks            runs until so many records are taken, or nothing has happened for so
//                                        many clocks: u32 count, then of each eight bytes and a byte of
//                                        marks, 1 begins a frame, 2 ends the row
//   'C'                                  five u64: clocks in all; those of the frame's first pixel, its last
//                                        one, its first record and its last one
//   'Q'                                  ends

#include "Vstereo.h"
#include "verilated.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <memory>
#include <vector>

namespace {

struct Pixel {
    uint16_t data;
    bool begins, ends;
};

struct Record {
    uint64_t data;
    uint8_t marks;
};

class Simulation {
public:
    Simulation() : block(new Vstereo) {
        block->reset = 1;
        for (int i = 0; i < 4; i++) clock();
        block->reset = 0;
        clock();
    }

    // One clock: inputs are set, outputs looked at before the edge, then the edge.
    void clock() {
        if (!offers && !pixels.empty() && pause == 0 && !happens(gaps)) offers = true;
        if (pause > 0) pause--;
        block->s_axis_tvalid = offers;
        if (offers) {
            block->s_axis_tdata = pixels.front().data;
            block->s_axis_tuser = pixels.front().begins;
            block->s_axis_tlast = pixels.front().ends;
        }
        block->m_axis_tready = wanted > 0 && !happens(stalls);
        block->clk = 0;
        block->eval();
        bool moved = false;
        if (offers && block->s_axis_tready) {
            if (pixels.front().begins) first_pixel = clocks;
            last_pixel = clocks;
            if (pixels.front().ends && gaps > 0 && random() % 8 == 0) pause = random() % 300;
            pixels.pop_front();
            offers = false;
            moved = true;
        }
        if (block->m_axis_tvalid && block->m_axis_tready) {
            const uint8_t marks = (block->m_axis_tuser ? 1 : 0) | (block->m_axis_tlast ? 2 : 0);
            if (marks & 1) first_record = clocks;
            last_record = clocks;
            records.push_back({block->m_axis_tdata, marks});
            wanted--;
            moved = true;
        }
        acknowledged = block->wb_ack_o;
        answer = block->wb_dat_o;
        block->clk = 1;
        block->eval();
        clocks++;
        quiet = moved || pause > 0 ? 0 : quiet + 1;
    }

    uint32_t bus(uint8_t offset, bool writes, uint32_t value) {
        block->wb_cyc_i = 1;
        block->wb_stb_i = 1;
        block->wb_we_i = writes;
        block->wb_adr_i = offset >> 2;
        block->wb_dat_i = value;
        do clock();
        while (!acknowledged);
        block->wb_cyc_i = 0;
        block->wb_stb_i = 0;
        return answer;
    }

    std::unique_ptr<Vstereo> block;
    std::deque<Pixel> pixels;
    std::vector<Record> records;
    uint64_t clocks = 0, first_pixel = 0, last_pixel = 0, first_record = 0, last_record = 0;
    uint32_t wanted = 0, quiet = 0, gaps = 0, stalls = 0, state = 1, pause = 0;

private:
    // xorshift32 (Marsaglia 2003).
    uint32_t random() {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        return state >> 4;
    }

    bool happens(uint32_t percent) { return percent > 0 && random() % 100 < percent; }

    bool offers = false, acknowledged = false;
    uint32_t answer = 0;
};

[[noreturn]] void end(int status) {
    std::fflush(stdout);
    std::_Exit(status);
}

void read(void *to, size_t bytes) {
    if (std::fread(to, 1, bytes, stdin) != bytes) end(1);
}

template <typename T> T read() {
    T value;
    read(&value, sizeof value);
    return value;
}

template <typename T> void write(T value) {
    if (std::fwrite(&value, sizeof value, 1, stdout) != 1) end(1);
}

} // namespace

int main(int argc, char **argv) {
    Verilated::commandArgs(argc, argv);
    Simulation simulation;
    for (;;) {
        switch (read<char>()) {
        case 'W': {
            const auto offset = read<uint8_t>();
            simulation.bus(offset, true, read<uint32_t>());
            break;
        }
        case 'R':
            write(simulation.bus(read<uint8_t>(), false, 0));
            break;
        case 'P':
            simulation.state = read<uint32_t>() | 1;
            simulation.gaps = read<uint8_t>();
            simulation.stalls = read<uint8_t>();
            break;
        case 'L': {
            const auto marks = read<uint8_t>();
            const auto count = read<uint32_t>();
            std::vector<uint16_t> line(count);
            read(line.data(), 2 * size_t(count));
            for (uint32_t i = 0; i < count; i++) {
                simulation.pixels.push_back({line[i], i == 0 && (marks & 1), i + 1 == count && (marks & 2)});
            }
            break;
        }
        case 'T': {
            simulation.wanted = read<uint32_t>();
            const auto limit = read<uint32_t>();
            simulation.quiet = 0;
            while (simulation.wanted > 0 && simulation.quiet < limit) simulation.clock();
            simulation.wanted = 0;
            write(uint32_t(simulation.records.size()));
            for (const Record &record : simulation.records) {
                write(record.data);
                write(record.marks);
            }
            simulation.records.clear();
            break;
        }
        case 'C':
            write(simulation.clocks);
            write(simulation.first_pixel);
            write(simulation.last_pixel);
            write(simulation.first_record);
            write(simulation.last_record);
            break;
        case 'Q':
            end(0);
        default:
            end(2);
        }
        std::fflush(stdout);
    }
}
