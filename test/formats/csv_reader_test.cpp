#include "demo_logger/formats/csv_reader.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <random>

#include "demo_logger/formats/csv_writer.h"
#include "demo_logger/trajectory/error.h"
#include "test/formats/temporary_folder.h"

namespace demo_logger {
namespace {

using Rows = std::vector<std::vector<double>>;

const double kMissing = std::numeric_limits<double>::quiet_NaN();

Rows readAll(const std::filesystem::path& file, const CsvExpectation& expectation = {}) {
  CsvReader reader(file, expectation);
  Rows rows;
  std::vector<double> row;
  while (reader.next(row)) {
    rows.push_back(row);
  }
  return rows;
}

Rows readText(const std::string& text) {
  const TemporaryFolder folder;
  return readAll(folder.write("reach_07.csv", text));
}

// What the FileError says about `text`, from "reach_07.csv" on.
std::string errorOf(const std::string& text, const CsvExpectation& expectation = {}) {
  const TemporaryFolder folder;
  const auto file = folder.write("reach_07.csv", text);
  try {
    readAll(file, expectation);
  } catch (const FileError& error) {
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
  return "no error";
}

void expectEqual(const Rows& found, const Rows& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].size(), expected[i].size()) << "row " << i;
    for (std::size_t k = 0; k < found[i].size(); ++k) {
      EXPECT_TRUE(found[i][k] == expected[i][k] || (std::isnan(found[i][k]) && std::isnan(expected[i][k])))
          << "row " << i << ", cell " << k << ": " << found[i][k] << " instead of " << expected[i][k];
    }
  }
}

TEST(CsvReaderTest, AWordIsTakenOnlyWhereItIsExpected) {
  const std::string text = "x,status\n1,solved\n2,3\n";
  EXPECT_EQ(errorOf(text, {{}, false}),
            "reach_07.csv:2: column 2 (status) is \"solved\", expected a number, or NaN where the value is missing. "
            "Remove a second line of units or names.");
  const TemporaryFolder folder;
  CsvReader reader(folder.write("reach_07.csv", text), {{}, false, {"status", "absent"}});
  std::vector<double> row;
  ASSERT_TRUE(reader.next(row));
  EXPECT_EQ(reader.word(1), "solved");
  EXPECT_EQ(row[0], 1.0);
  EXPECT_TRUE(std::isnan(row[1]));
  ASSERT_TRUE(reader.next(row));
  EXPECT_EQ(reader.word(1), "") << "a number is no word";
  EXPECT_EQ(row[1], 3.0);
  EXPECT_EQ(errorOf("x,status\nno,solved\n", {{}, false, {"status"}}),
            "reach_07.csv:2: column 1 (x) is \"no\", expected a number, or NaN where the value is missing. Remove a "
            "second line of units or names.");
}

TEST(CsvReaderTest, ReadsNamesAndRows) {
  const TemporaryFolder folder;
  CsvReader reader(folder.write("a.csv", "time,q_elbow\n0,1.5\n0.01,NaN\n"));
  EXPECT_EQ(reader.names(), (std::vector<std::string>{"time", "q_elbow"}));
  EXPECT_EQ(reader.find("q_elbow"), 1U);
  EXPECT_EQ(reader.find("q_wrist"), std::nullopt);
  std::vector<double> row;
  ASSERT_TRUE(reader.next(row));
  EXPECT_EQ(row, (std::vector<double>{0.0, 1.5}));
  ASSERT_TRUE(reader.next(row));
  EXPECT_EQ(reader.line(), 3U);
  EXPECT_TRUE(std::isnan(row[1]));
  EXPECT_FALSE(reader.next(row));
  EXPECT_TRUE(reader.notes().empty());
}

TEST(CsvReaderTest, ToleratesWhatOthersWriteAsLongAsItLeavesNoDoubt) {
  const Rows expected = {{0.0, 1.0}, {1.0, kMissing}};
  expectEqual(readText("time,q\r\n0,1\r\n1,NaN\r\n"), expected);
  expectEqual(readText("\xef\xbb\xbftime,q\n0,1\n1,NaN\n"), expected);
  expectEqual(readText("\"time\", \"q\"\n 0, +1\n1 ,\tnan \n"), expected);
  expectEqual(readText("time,q\n0,1\n1,\n"), expected);
  expectEqual(readText("time,q\n0,1\n1,NA\n"), expected);
  expectEqual(readText("time,q\n0,1\n1,-NAN\n"), expected);
  expectEqual(readText("time,q\n0,1e0\n1,na\n\n\r\n\n"), expected);
  expectEqual(readText("q,time\n0,1\nNaN,2\n"), {{0.0, 1.0}, {kMissing, 2.0}});
}

TEST(CsvReaderTest, EveryNaNReadsAsTheSameBits) {
  const Rows rows = readText("time,a,b\n0,NaN,-nan\n");
  EXPECT_FALSE(std::signbit(rows[0][1]));
  EXPECT_FALSE(std::signbit(rows[0][2]));
}

TEST(CsvReaderTest, SubnormalsAndTheLargestNumbersAreRead) {
  expectEqual(readText("time,a,b,c\n0,5e-324,1.7976931348623157e+308,-0.0\n"),
              {{0.0, 5e-324, std::numeric_limits<double>::max(), -0.0}});
}

TEST(CsvReaderTest, TimesMustIncrease) {
  EXPECT_EQ(errorOf("time,q\n3.125,1\n3.12,1\n"),
            "reach_07.csv:3: time 3.12 s does not follow 3.125 s; times must strictly increase. Were two recordings "
            "joined?");
  EXPECT_EQ(
      errorOf("time,q\n1,1\n1,1\n"),
      "reach_07.csv:3: time 1 s is that of the row before; times must strictly increase. Was a row written twice?");
  EXPECT_EQ(errorOf("q,time\n1,NaN\n"),
            "reach_07.csv:2: column 2 (time) is missing, expected the seconds since the first row.");
}

TEST(CsvReaderTest, EveryRowHasAsManyCellsAsTheHeader) {
  EXPECT_EQ(errorOf("time,q,dq\n0,1\n"),
            "reach_07.csv:2: the row has 2 cells, expected 3 as in the header. Was the line cut?");
  EXPECT_EQ(errorOf("time,q\n0,1,\n"),
            "reach_07.csv:2: the row has 3 cells, expected 2 as in the header. Does it end with a comma?");
  EXPECT_EQ(errorOf("time,q\n0,0,1,5\n"),
            "reach_07.csv:2: the row has 4 cells, expected 2 as in the header. Is a comma used as decimal mark?");
}

TEST(CsvReaderTest, ACellThatIsNoNumberIsNamedWithItsColumn) {
  EXPECT_EQ(errorOf("time,q,status\n0,1,1\n1,2,tracked\n"),
            "reach_07.csv:3: column 3 (status) is \"tracked\", expected a number, or NaN where the value is missing.");
  EXPECT_EQ(errorOf("time,q\ns,rad\n0,1\n"),
            "reach_07.csv:2: column 1 (time) is \"s\", expected a number, or NaN where the value is missing. Remove a "
            "second line of units or names.");
  EXPECT_EQ(
      errorOf("time,q\n0,1\n# joined here\n1,2\n"),
      "reach_07.csv:3: column 1 (time) is \"# joined here\", expected a number, or NaN where the value is missing. "
      "Remove the comment lines.");
  EXPECT_EQ(errorOf("time,q\n0,1\n1,\"2\"\n"),
            "reach_07.csv:3: column 2 (q) is \"\"2\"\", expected a number, or NaN where the value is missing. Write "
            "numbers without quotes.");
  for (const char* cell :
       {"1.5.2", "0x10", "1e", "--1", "+-1", "1 2", "1_000", "nan(7)", "N/A", "null", "true", "1d"}) {
    EXPECT_EQ(errorOf("time,q\n0,0\n1," + std::string(cell) + "\n"),
              "reach_07.csv:3: column 2 (q) is \"" + std::string(cell) +
                  "\", expected a number, or NaN where the value is missing.");
  }
}

TEST(CsvReaderTest, LongAndUnprintableCellsAreShortenedInTheMessage) {
  EXPECT_EQ(errorOf("time,q\n0,0\n1,\x1b[31m" + std::string(90, 'x') + "\n"),
            "reach_07.csv:3: column 2 (q) is \"?[31m" + std::string(75, 'x') +
                "…\", expected a number, or NaN where the value is missing.");
}

TEST(CsvReaderTest, InfinitiesAndNumbersBeyondADoubleAreRefused) {
  for (const char* cell : {"inf", "-inf", "Infinity", "INF"}) {
    EXPECT_EQ(errorOf("time,q\n0," + std::string(cell) + "\n"),
              "reach_07.csv:2: column 2 (q) is \"" + std::string(cell) +
                  "\", expected a finite number, or NaN where the value is missing.");
  }
  EXPECT_EQ(errorOf("time,q\n0,1e400\n"),
            "reach_07.csv:2: column 2 (q) is \"1e400\", expected a number within the range of a double (5e-324 to "
            "1.8e308).");
}

TEST(CsvReaderTest, EmptyFilesAndHeadersWithoutRowsAreTold) {
  EXPECT_EQ(errorOf(""), "reach_07.csv: is empty, expected a header line of column names and rows of numbers.");
  EXPECT_EQ(
      errorOf("time,q\n"),
      "reach_07.csv:1: the file has a header and no rows; expected at least one row of numbers. Was the recording "
      "stopped at once?");
  EXPECT_EQ(errorOf("time,q"), errorOf("time,q\n"));
}

TEST(CsvReaderTest, HeadersThatCannotBeTrustedAreRefused) {
  EXPECT_EQ(errorOf("time,q,q\n0,1,2\n"),
            "reach_07.csv:1: two columns are named \"q\"; names must be unique. Rename one of them.");
  EXPECT_EQ(errorOf("time,q,\n0,1,2\n"), "reach_07.csv:1: column 3 has no name; does the header end with a comma?");
  EXPECT_EQ(errorOf("\"\",time\n0,1\n"), "reach_07.csv:1: column 1 has no name; every column needs one.");
  EXPECT_EQ(errorOf("\ntime\n0\n"), "reach_07.csv:1: column 1 has no name; every column needs one.");
  EXPECT_EQ(errorOf("0,1.5\n1,2.5\n"),
            "reach_07.csv:1: the first line holds numbers, expected a header line of column names.");
  EXPECT_EQ(
      errorOf("time;q\n0,5;1\n"),
      "reach_07.csv:1: the header has semicolons or tabs and no commas, expected a comma between cells and a point "
      "in numbers.");
  EXPECT_EQ(
      errorOf("# made by x\ntime,q\n0,1\n"),
      "reach_07.csv:1: the file starts with a comment, expected a header line of column names. Remove the comment "
      "lines.");
  EXPECT_EQ(errorOf("time,q\r0,1\r1,2\r"),
            "reach_07.csv:1: lines end in CR alone, expected LF or CR LF. Save the file with line ends of Unix or "
            "Windows.");
}

TEST(CsvReaderTest, MissingColumnsAreNamedBesideThoseThatAreThere) {
  EXPECT_EQ(errorOf("stamp,q\n0,1\n"),
            "reach_07.csv:1: there is no column `time`, expected the seconds since the first row; found stamp, q.");
  EXPECT_EQ(errorOf("time,a,b,c,d,e,f\n0,1,2,3,4,5,6\n", {{"q_elbow"}, true}),
            "reach_07.csv:1: there is no column `q_elbow`; found time, a, b, c, d, e, … (7 columns).");
}

TEST(CsvReaderTest, ATableNeedsNoTimeUnlessAsked) {
  const TemporaryFolder folder;
  const auto file = folder.write("poses.csv", "x,y\n2,1\n1,1\n");
  expectEqual(readAll(file, {{"x"}, false}), {{2.0, 1.0}, {1.0, 1.0}});
}

TEST(CsvReaderTest, ARowThatWasCutIsTold) {
  EXPECT_EQ(
      errorOf("time,q,dq\n0,1,2\n1,1"),
      "reach_07.csv:3: the row ends after 2 of 3 cells and without a line feed; the file was cut here. Remove this "
      "last line to use the rows before it.");
  EXPECT_EQ(
      errorOf("time,q,dq\n0,1,2\n1,1,"),
      "reach_07.csv:3: the row ends after 2 of 3 cells and without a line feed; the file was cut here. Remove this "
      "last line to use the rows before it.");
  EXPECT_EQ(errorOf("time,q,dq\n0,1,2\n1,1,2e-"),
            "reach_07.csv:3: column 3 (dq) is \"2e-\", expected a number, or NaN where the value is missing. The file "
            "ends here without a line feed; was it cut?");
}

TEST(CsvReaderTest, ACompleteLastRowWithoutLineFeedIsReadWithANote) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.csv", "time,q\n0,1\n1,2");
  CsvReader reader(file);
  std::vector<double> row;
  ASSERT_TRUE(reader.next(row));
  EXPECT_TRUE(reader.notes().empty());
  ASSERT_TRUE(reader.next(row));
  EXPECT_EQ(row, (std::vector<double>{1.0, 2.0}));
  EXPECT_FALSE(reader.next(row));
  ASSERT_EQ(reader.notes().size(), 1U);
  EXPECT_EQ(reader.notes()[0], file.string() +
                                   ":3: ends without a line feed; if the file was cut, the last number of "
                                   "its last row is wrong.");
}

TEST(CsvReaderTest, NulBytesAreNamed) {
  EXPECT_EQ(errorOf(std::string("time,q\n0,1\n1,\0\0\0\n", 16)),
            "reach_07.csv:3: column 2 (q) holds a NUL byte, expected a number. Was the power lost while the file was "
            "written?");
  EXPECT_EQ(errorOf(std::string("t\0i\0m\0e\0\n\0", 10)),
            "reach_07.csv:1: the header holds a NUL byte, expected column names as UTF-8 text. Is it UTF-16, or not a "
            "CSV file?");
}

TEST(CsvReaderTest, ABlankLineBetweenRowsIsNamed) {
  EXPECT_EQ(errorOf("time,q\n0,1\n\n1,2\n"),
            "reach_07.csv:3: the line is empty, expected a row of 2 numbers. Remove the line.");
}

TEST(CsvReaderTest, AGigabyteWithoutALineFeedIsRefusedWithoutReadingIt) {
  const TemporaryFolder folder;
  const auto file = folder.write("huge.csv", "time,q\n0,");
  ASSERT_EQ(truncate(file.c_str(), 1L << 30U), 0) << "a sparse file: all zeros, no disk used";
  rusage before = {};
  getrusage(RUSAGE_SELF, &before);
  try {
    readAll(file);
    FAIL() << "a row of a gigabyte was accepted";
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(),
              file.string() + ":2: the line is longer than 16 MB, expected a row of 2 numbers. Is the file damaged?");
  }
  rusage after = {};
  getrusage(RUSAGE_SELF, &after);
#ifdef __SANITIZE_THREAD__
  constexpr long kShadow = 5;  // ThreadSanitizer's memory about the memory
#else
  constexpr long kShadow = 1;
#endif
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, kShadow * (100L << 10U)) << "kilobytes; the line itself has a million";
}

TEST(CsvReaderTest, AHeaderOfManyMegabytesIsRefused) {
  EXPECT_EQ(errorOf(std::string(2U << 20U, 'x')),
            "reach_07.csv:1: the first line is longer than 1 MB, expected a header line of column names. Is this a CSV "
            "file?");
}

TEST(CsvReaderTest, WhatNeverEndsOrNeverBeginsIsNamedInsteadOfReadOrWaitedFor) {
  const TemporaryFolder folder;
  const std::filesystem::path endless = folder.path() / "endless.csv";
  const std::filesystem::path pipe = folder.path() / "pipe.csv";
  std::filesystem::create_symlink("/dev/zero", endless);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const auto refusalOf = [](const std::filesystem::path& file) -> std::string {
    try {
      readAll(file);
    } catch (const FileError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_EQ(refusalOf(endless), endless.string() + ": is a device, expected a CSV file.");
  EXPECT_EQ(refusalOf(pipe), pipe.string() + ": is a pipe, expected a CSV file.");
}

TEST(CsvReaderTest, DirectoriesAndMissingFilesAreNamed) {
  const TemporaryFolder folder;
  EXPECT_THROW(
      {
        try {
          readAll(folder.path());
        } catch (const FileError& error) {
          EXPECT_EQ(error.what(),
                    folder.path().string() + ": is a directory, expected a CSV file. Name one of the files in it.");
          throw;
        }
      },
      FileError);
  EXPECT_THROW(
      {
        try {
          readAll(folder.path() / "none.csv");
        } catch (const FileError& error) {
          EXPECT_EQ(error.what(), (folder.path() / "none.csv").string() +
                                      ": cannot be read (No such file or directory); expected a CSV file that exists "
                                      "and may be read.");
          throw;
        }
      },
      FileError);
}

TEST(CsvReaderTest, AFileWithoutTheRightToReadIsNamed) {
  const TemporaryFolder folder;
  const auto file = folder.write("secret.csv", "time\n0\n");
  std::filesystem::permissions(file, std::filesystem::perms::none);
  constexpr uid_t kNobody = 65534;
  const uid_t user = geteuid();
  const bool is_root = user == 0;  // who may read everything
  if (is_root) {
    ASSERT_EQ(seteuid(kNobody), 0);
  }
  std::string message = "no error";
  try {
    readAll(file);
  } catch (const FileError& error) {
    message = error.what();
  }
  if (is_root) {
    ASSERT_EQ(seteuid(user), 0);
  }
  EXPECT_EQ(message,
            file.string() + ": cannot be read (Permission denied); expected a CSV file that exists and may be read.");
}

// Rows of any length around the buffer's size, so that lines fall across its ends.
RC_GTEST_PROP(CsvReaderTest, ReadsBackAnyRowsThatTheWriterWrote, ()) {
  const auto columns = *rc::gen::inRange<std::size_t>(1, 2000);
  const auto rows = *rc::gen::inRange<std::size_t>(1, 30);
  std::string text = "time";
  for (std::size_t i = 0; i < columns; ++i) {
    text += ",c" + std::to_string(i);
  }
  text += '\n';
  const auto seed = *rc::gen::arbitrary<std::uint32_t>();
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> values(-1e3, 1e3);
  Rows expected;
  for (std::size_t i = 0; i < rows; ++i) {
    std::vector<double> row = {static_cast<double>(i) / 1000.0};
    for (std::size_t k = 0; k < columns; ++k) {
      row.push_back(values(generator));
    }
    appendRow(text, row[0], row.data() + 1, columns);
    expected.push_back(row);
  }
  RC_ASSERT(readText(text) == expected);
}

// Whatever the bytes: rows, or one sentence that names the file; never a crash, never rows of another width.
RC_GTEST_PROP(CsvReaderTest, AnyBytesGiveRowsOrASentence, ()) {
  const auto body = *rc::gen::container<std::string>(
      rc::gen::element('0', '1', '9', '.', ',', ',', '\n', '\n', '\r', 'e', '-', '+', 'N', 'a', '\0', ' ', '"', '#'));
  const TemporaryFolder folder;
  const auto file = folder.write("any.csv", "time,q\n0,1\n" + body);
  try {
    for (const std::vector<double>& row : readAll(file)) {
      RC_ASSERT(row.size() == 2U);
      RC_ASSERT(!std::isinf(row[1]));
    }
  } catch (const FileError& error) {
    RC_ASSERT(std::string(error.what()).find("any.csv:") != std::string::npos);
  }
}

}  // namespace
}  // namespace demo_logger
