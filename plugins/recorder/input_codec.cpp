#include "input_codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "range_coder.h"
#include "spark/error.h"

namespace spark::recorder {

namespace {
constexpr unsigned kEnd = 8;                               // among kinds of inputs: there are no more
constexpr std::int64_t kMostTime = std::int64_t{1} << 53;  // us

constexpr int kMarks = 8;  // characters 1 to 8 stand for numbers with 0 to 7 decimals
constexpr std::int64_t kMostDigits = std::int64_t{1} << 53;
constexpr unsigned kClientBits = 8, kWordBits = 10;
constexpr std::size_t kMostClients = (1u << kClientBits) - 1, kMostWords = 1u << kWordBits;
constexpr std::size_t kMostPlaceLength = 200, kMostWordLength = 200, kMostNumbers = 16, kMostNumbersInAll = 1024;
constexpr std::uint32_t kTextEnd = 0, kNewWord = 1, kFirstWord = 2;  // among words
constexpr unsigned kChanges = 24;  // differences are told apart by how many bits the one before had

// A reader takes at most kMostBytes of inputs from a piece. A writer puts about kPieceBytes into one, and refuses a
// single input of more than kMostInput.
constexpr std::size_t kMostBytes = 64u << 20, kPieceBytes = 16u << 20, kMostInput = 48u << 20;

/// True if inputs of a kind have place, key and text; the others have a number only.
bool isLong(Input::Kind kind) { return kind != Input::Kind::cycle && kind != Input::Kind::time; }

void putNumber(std::string& out, std::uint64_t v) {
  for (; v >= 0x80; v >>= 7) out += static_cast<char>(v | 0x80);
  out += static_cast<char>(v);
}

std::uint64_t takeNumber(std::string_view& bytes) {
  std::uint64_t out = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    if (bytes.empty()) break;
    const auto b = static_cast<unsigned char>(bytes.front());
    bytes.remove_prefix(1);
    out |= static_cast<std::uint64_t>(b & 0x7f) << shift;
    if ((b & 0x80) == 0) return out;
  }
  throw Error("inputs are damaged: a number has no end");
}

bool isMark(char c) { return c >= 1 && c <= kMarks; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// A number that is written back with the same characters.
struct Decimal {
  std::size_t length = 0;  ///< of its characters; 0: there is none
  int decimals = 0;
  std::int64_t value = 0;  ///< its digits; -1 - them if it is negative, for there is -0.0
};

/// The number at the front of a text.
Decimal decimalAt(std::string_view text) {
  std::size_t at = text.starts_with('-') ? 1 : 0;
  const bool negative = at > 0;
  const std::size_t first = at;
  std::int64_t digits = 0;
  const auto read = [&] {
    for (; at < text.size() && isDigit(text[at]) && digits < kMostDigits; ++at) digits = 10 * digits + (text[at] - '0');
  };
  read();
  if (at == first || (text[first] == '0' && at > first + 1)) return {};
  std::size_t decimals = 0;
  if (at + 1 < text.size() && text[at] == '.' && isDigit(text[at + 1])) {
    const std::size_t point = at++;
    read();
    decimals = at - point - 1;
  }
  if (decimals >= kMarks || digits >= kMostDigits || (at < text.size() && isDigit(text[at]))) return {};
  return {at, static_cast<int>(decimals), negative ? -1 - digits : digits};
}

void putDecimal(std::string& out, std::int64_t value, int decimals) {
  if (value < 0) out += '-';
  std::string digits = std::to_string(value < 0 ? -1 - value : value);
  const auto n = static_cast<std::size_t>(decimals);
  if (digits.size() <= n) digits.insert(0, n + 1 - digits.size(), '0');
  out.append(digits, 0, digits.size() - n);
  if (n > 0) out.append(1, '.').append(digits, digits.size() - n, n);
}

/// The length of the first word of a text: it ends before the next parenthesis that opens.
std::size_t wordLength(std::string_view text) { return std::min(text.find('(', 1), text.size()); }

/// A word without its numbers.
struct Pattern {
  std::string text;  ///< marks in place of numbers
  std::vector<std::int64_t> numbers;
};

/// Empty if the word must stand as it is.
std::optional<Pattern> patternOf(std::string_view word) {
  Pattern out;
  char before = 0;
  while (!word.empty()) {
    const bool inside = isDigit(before) || isLetter(before) || before == '.';
    const Decimal found = inside ? Decimal{} : decimalAt(word);
    const std::size_t n = std::max<std::size_t>(found.length, 1);
    if (found.length > 0) {
      out.text += static_cast<char>(1 + found.decimals);
      out.numbers.push_back(found.value);
    } else {
      if (isMark(word.front())) return {};
      out.text += word.front();
    }
    before = word[n - 1];
    word.remove_prefix(n);
    if (out.text.size() > kMostWordLength || out.numbers.size() > kMostNumbers) return {};
  }
  return out;
}

/// The text of a pattern with numbers, one for each mark.
template <class Slots>
std::string filled(std::string_view pattern, const Slots& slots) {
  std::string out;
  std::size_t i = 0;
  for (const char c : pattern)
    if (isMark(c))
      putDecimal(out, slots[i++].value, c - 1);
    else
      out += c;
  return out;
}

std::int64_t sum(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}
std::int64_t difference(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

/// Kinds of changes: by the bits of the one before, and by the signs of the value and of that change.
unsigned bitsOf(std::int64_t change) {
  const auto size = static_cast<std::uint64_t>(change);
  return std::min(static_cast<unsigned>(std::bit_width(change < 0 ? 0 - size : size)), kChanges - 1);
}
unsigned signsOf(std::int64_t value, std::int64_t change) {
  const auto sign = [](std::int64_t v) { return v < 0 ? 0u : v == 0 ? 1u : 2u; };
  return 3 * sign(value) + sign(change);
}
}  // namespace

/// What is known from the inputs before: the same where they are written and where they are read, and so is the
/// description of the format; `Coder` is one of range_coder.h.
struct InputModel {
  /// Begins a piece.
  void begin() { left_ = kMostBytes; }
  /// Number of the piece since the last restart.
  std::uint64_t piece = 0;
  /// Codes an input; false: there are no more. `in`: the input; if it is read, an empty one that gets it.
  template <class Coder>
  bool code(Coder& coder, bool more, OwnInput& in);

 private:
  /// A number of a word, as a client sent it last.
  struct Slot {
    std::int64_t value = 0, change = 0;  ///< the change is that from the value before
  };
  using SlotNumber = Number<kChanges, 9>;
  /// A word that clients sent.
  struct Word {
    std::string pattern;
    std::vector<SlotNumber> numbers{};
    Chance followed{};  ///< that the word follows it which followed when the client sent it last
  };
  struct Client {
    std::string place;
    std::uint64_t key = 0;
    std::size_t next = 0;  ///< the client that followed
    struct Said {
      std::uint32_t next = kTextEnd;  ///< the word that followed
      std::vector<Slot> slots{};
    };
    std::vector<Said> said{};  ///< by word
    Said& about(std::uint32_t word) {
      if (word >= said.size()) said.resize(word + 1);
      return said[word];
    }
  };

  void spend(std::size_t bytes);
  template <class Coder>
  void spell(Coder& coder, std::string& text);
  template <class Coder>
  Client& codeClient(Coder& coder, OwnInput& in);
  template <class Coder>
  void codeText(Coder& coder, Client& client, std::string& text);
  template <class Coder>
  bool codeNewWord(Coder& coder, std::string& raw, std::optional<Pattern>& pattern);
  std::uint32_t idOf(const std::optional<Pattern>& pattern) const;
  bool hasRoomFor(std::size_t numbers) const;

  Symbol<4> kinds_[kEnd + 1];
  unsigned lastKind_ = kEnd;
  Number<> numbers_[kEnd], keys_, textLengths_;
  std::int64_t lastNumbers_[kEnd] = {};
  Symbol<8> characters_;
  Symbol<kClientBits> whichClient_;
  Symbol<kWordBits> whichWord_;
  Chance clientFollowed_, wordKept_;
  std::vector<Client> clients_ = std::vector<Client>(1);  ///< the first one is none
  Client unknown_;                                        ///< one for which there is no room
  std::size_t lastClient_ = 0;
  std::vector<Word> words_ = std::vector<Word>(kFirstWord);
  std::map<std::string, std::uint32_t, std::less<>> ids_;  ///< of words_, by pattern
  std::size_t numbersOfWords_ = 0;
  std::size_t left_ = 0;  ///< bytes that the inputs of the piece may still have
};

/// So that a few bytes do not become endlessly many. Throws Error.
void InputModel::spend(std::size_t bytes) {
  if (bytes > left_) throw Error(fmt::format("a piece of inputs has more than {} bytes", kMostBytes));
  left_ -= bytes;
}

template <class Coder>
bool InputModel::code(Coder& coder, bool more, OwnInput& in) {
  const unsigned kind = kinds_[lastKind_].code(coder, more ? static_cast<unsigned>(in.kind) : kEnd);
  if (kind > kEnd) throw Error("inputs are damaged: an unknown kind");
  lastKind_ = kind;
  if (kind == kEnd) return false;
  spend(sizeof in);
  in.kind = static_cast<Input::Kind>(kind);
  std::int64_t& last = lastNumbers_[kind];
  last = in.number = sum(last, numbers_[kind].code(coder, difference(in.number, last)));
  if (Coder::kReads && in.kind == Input::Kind::time && (in.number > kMostTime || in.number < -kMostTime))
    throw Error("inputs are damaged: a time is out of range");
  if (isLong(in.kind)) codeText(coder, codeClient(coder, in), in.text);
  return true;
}

template <class Coder>
void InputModel::spell(Coder& coder, std::string& text) {
  const std::int64_t size = textLengths_.code(coder, static_cast<std::int64_t>(text.size()));
  if (size < 0) throw Error("inputs are damaged: a text is shorter than nothing");
  spend(static_cast<std::size_t>(size));
  for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i) {
    if (Coder::kReads) text.push_back(0);
    text[i] = static_cast<char>(characters_.code(coder, static_cast<unsigned char>(text[i])));
  }
}

/// Codes place and key.
template <class Coder>
InputModel::Client& InputModel::codeClient(Coder& coder, OwnInput& in) {
  std::size_t& next = clients_[lastClient_].next;
  const auto known = std::find_if(clients_.begin() + 1, clients_.end(),
                                  [&](const Client& c) { return c.key == in.key && c.place == in.place; });
  std::size_t client = known == clients_.end() ? 0 : static_cast<std::size_t>(known - clients_.begin());
  client = coder.bit(clientFollowed_, client == next) ? next : whichClient_.code(coder, static_cast<unsigned>(client));
  if (client >= clients_.size()) throw Error("inputs are damaged: an unknown client");
  next = client;  // of the last one
  if (client == 0) {
    spell(coder, in.place);
    in.key = static_cast<std::uint64_t>(keys_.code(coder, static_cast<std::int64_t>(in.key)));
    if (clients_.size() == kMostClients || in.place.size() > kMostPlaceLength) return unknown_ = Client{};
    client = next = clients_.size();
    clients_.push_back({in.place, in.key});  // `next` is no more
  } else if (Coder::kReads) {
    spend(clients_[client].place.size());
    in.place = clients_[client].place;
    in.key = clients_[client].key;
  }
  lastClient_ = client;
  return clients_[client];
}

bool InputModel::hasRoomFor(std::size_t numbers) const {
  return words_.size() < kMostWords && numbersOfWords_ + numbers <= kMostNumbersInAll;
}

std::uint32_t InputModel::idOf(const std::optional<Pattern>& pattern) const {
  const auto found = pattern ? ids_.find(pattern->text) : ids_.end();
  return found == ids_.end() ? kNewWord : found->second;
}

/// Codes a word that is not known. False: it stands as it is, in `raw`, and is not kept.
template <class Coder>
bool InputModel::codeNewWord(Coder& coder, std::string& raw, std::optional<Pattern>& pattern) {
  const bool keeps = coder.bit(wordKept_, pattern && hasRoomFor(pattern->numbers.size()));
  if (Coder::kReads) pattern.emplace();
  std::string& text = keeps ? pattern->text : raw;
  spell(coder, text);
  if (text.empty()) throw Error("inputs are damaged: a word has no characters");
  if (!keeps) return false;
  const auto numbers = static_cast<std::size_t>(std::count_if(pattern->text.begin(), pattern->text.end(), isMark));
  if (text.size() > kMostWordLength || numbers > kMostNumbers || !hasRoomFor(numbers) || idOf(pattern) != kNewWord)
    throw Error("inputs are damaged: a word that is none");
  ids_[pattern->text] = static_cast<std::uint32_t>(words_.size());
  words_.push_back({pattern->text, std::vector<SlotNumber>(numbers)});
  numbersOfWords_ += numbers;
  return true;
}

template <class Coder>
void InputModel::codeText(Coder& coder, Client& client, std::string& text) {
  std::string_view rest = text;  // that is to be written
  for (std::uint32_t before = kTextEnd;;) {
    std::string raw(rest.substr(0, wordLength(rest)));
    rest.remove_prefix(raw.size());
    std::optional<Pattern> pattern = Coder::kReads ? std::nullopt : patternOf(raw);
    const std::uint32_t guess = client.about(before).next;
    std::uint32_t id = raw.empty() ? kTextEnd : idOf(pattern);
    id = coder.bit(words_[before].followed, id == guess) ? guess : whichWord_.code(coder, id);
    if (id >= words_.size()) throw Error("inputs are damaged: an unknown word");
    if (id == kNewWord) {
      if (!codeNewWord(coder, raw, pattern)) {
        if (Coder::kReads) text += raw;
        continue;
      }
      id = static_cast<std::uint32_t>(words_.size() - 1);
    }
    client.about(before).next = id;
    if (id == kTextEnd) return;
    Word& word = words_[id];
    std::vector<Slot>& slots = client.about(id).slots;
    slots.resize(word.numbers.size());
    for (std::size_t i = 0; i < slots.size(); ++i) {
      Slot& s = slots[i];
      const std::int64_t given = Coder::kReads ? 0 : pattern->numbers[i];
      s.change = word.numbers[i].code(coder, difference(given, s.value), bitsOf(s.change), signsOf(s.value, s.change));
      s.value = sum(s.value, s.change);
    }
    if (Coder::kReads) {
      const std::string filledWord = filled(word.pattern, slots);
      spend(filledWord.size());
      text += filledWord;
    }
    before = id;
  }
}

void InputBatch::add(const Input& input) {
  entries_.push_back({input.kind, input.key, input.number, input.place.size(), input.text.size()});
  texts_.append(input.place).append(input.text);
}

InputBatch InputBatch::next() const {
  InputBatch out;
  out.entries_.reserve(entries_.size());
  out.texts_.reserve(texts_.size());
  return out;
}

std::vector<OwnInput> InputBatch::inputs() const {
  std::vector<OwnInput> out;
  out.reserve(entries_.size());
  std::size_t at = 0;
  for (const Entry& e : entries_) {
    out.push_back({e.kind, texts_.substr(at, e.place), e.key, e.number, texts_.substr(at + e.place, e.text)});
    at += e.place + e.text;
  }
  return out;
}

InputWriter::InputWriter() = default;
InputWriter::~InputWriter() = default;

void InputWriter::restart() { model_ = nullptr; }

std::vector<std::string> InputWriter::write(std::vector<OwnInput> inputs) {
  std::vector<std::string> out;
  // Lost if it throws: what follows could not be read.
  std::unique_ptr<InputModel> model = model_ ? std::move(model_) : std::make_unique<InputModel>();
  for (auto in = inputs.begin(); in != inputs.end();) {
    std::string& piece = out.emplace_back();
    putNumber(piece, model->piece++);
    RangeWriter coder(piece);
    model->begin();
    std::size_t bytes = 0;
    do {
      bytes += in->bytes();
      if (in->bytes() > kMostInput)
        throw Error(fmt::format("an input of {} bytes is too long to be recorded", in->bytes()));
      model->code(coder, true, *in++);
    } while (in != inputs.end() && bytes + in->bytes() <= kPieceBytes);
    OwnInput none;
    model->code(coder, false, none);
    coder.finish();
  }
  model_ = std::move(model);
  return out;
}

InputReader::InputReader() = default;
InputReader::~InputReader() = default;

void InputReader::restart() { model_ = nullptr; }

void InputReader::read(std::string_view piece, std::vector<OwnInput>& out) {
  std::unique_ptr<InputModel> model = std::move(model_);  // lost if the piece is damaged
  const std::uint64_t number = takeNumber(piece);
  if (number == 0) model = std::make_unique<InputModel>();
  if (!model || number != model->piece)
    throw Error(fmt::format("inputs are missing: expected a piece with the number {}, found {}",
                            model ? model->piece : 0, number));
  ++model->piece;
  RangeReader coder(piece);
  model->begin();
  for (OwnInput in; model->code(coder, true, in); in = {}) out.push_back(std::move(in));
  coder.finish();
  model_ = std::move(model);
}

}  // namespace spark::recorder
