#include "headless/stroke_file.hpp"

#include "headless/command_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <clocale>
#include <cmath>
#include <locale>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace haptoflow::headless {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string complaintAbout(const std::string& text) {
    try {
        static_cast<void>(parseStroke(text, "stroke.csv"));
    } catch (const InputError& error) {
        return error.what();
    }
    return "no complaint";
}

TEST(StrokeFileTest, EveryColumnIsRead) {
    const Stroke stroke = parseStroke(
        "t,x,y,z,force,qx,qy,qz,qw\n"
        "0.5,1e-3,-2,+3,0.7,0,0,0,2\n"
        "0.6,0,0,0,,0,1,0,0\n",
        "stroke.csv");
    ASSERT_EQ(stroke.samples.size(), 2U);
    EXPECT_DOUBLE_EQ(stroke.samples[0].timeSeconds, 0.5);
    EXPECT_EQ(stroke.samples[0].positionMetres, glm::dvec3(0.001, -2.0, 3.0));
    EXPECT_DOUBLE_EQ(stroke.samples[0].forceNewtons.value_or(-1.0), 0.7);
    EXPECT_EQ(stroke.samples[0].orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
    EXPECT_FALSE(stroke.samples[1].forceNewtons);
    EXPECT_EQ(stroke.samples[1].orientation, glm::dquat(0.0, 0.0, 1.0, 0.0));
}

TEST(StrokeFileTest, OptionalColumnsMayBeMissing) {
    EXPECT_FALSE(parseStroke("t,x,y,z\n0,0,0,0\n", "s").samples[0].forceNewtons);
    EXPECT_FALSE(parseStroke("t,x,y,z\n0,0,0,0\n", "s").samples[0].orientation);
    EXPECT_TRUE(parseStroke("t,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n", "s").samples[0].orientation);
    EXPECT_TRUE(parseStroke("t,x,y,z,force\n0,0,0,0,1\n", "s").samples[0].forceNewtons);
}

TEST(StrokeFileTest, WindowsLineEndsByteOrderMarkSpacesAndTrailingEmptyLinesAreAccepted) {
    const Stroke stroke = parseStroke("\xEF\xBB\xBFt, x, y, z\r\n 0 ,1 ,2,\t3\r\n1,1,2,3\r\n\r\n  \r\n", "stroke.csv");
    ASSERT_EQ(stroke.samples.size(), 2U);
    EXPECT_EQ(stroke.samples[0].positionMetres, glm::dvec3(1.0, 2.0, 3.0));
    EXPECT_EQ(parseStroke("t,x,y,z\n0,1,2,3", "stroke.csv").samples.size(), 1U);
}

TEST(StrokeFileTest, TablesOfSpreadsheetsAndInstrumentsAreRead) {
    for (const std::string text : {
             "t;x;y;z;force\n0;0,5;-1;2;0,25\n0,01;0;0;0;\n",
             "sep=;\r\nt;x;y;z;force\r\n0;0,5;-1;2;0,25\r\n0,01;0;0;0;N/A\r\n",
             "t\tx\ty\tz\tforce\r0\t0.5\t-1\t2\t0.25\r0.01\t0\t0\t0\tnull\r",
             " t  x y z force\n 0 0.5  \xE2\x88\x92"
             "1 2 0.25 \n0.01 0 0 0 nan\n",
             "\"t\",\"x\",\"y\",\"z\",\"force\",,\n0,\"0,5\",-1,2,\"0,25\",,\n\"0,01\",0,0,0,None,,\n,,,,,,\n",
         }) {
        SCOPED_TRACE(text);
        const Stroke stroke = parseStroke(text, "stroke.csv");
        ASSERT_EQ(stroke.samples.size(), 2U);
        EXPECT_EQ(stroke.samples[0].positionMetres, glm::dvec3(0.5, -1.0, 2.0));
        EXPECT_DOUBLE_EQ(stroke.samples[0].forceNewtons.value_or(-1.0), 0.25);
        EXPECT_DOUBLE_EQ(stroke.samples[1].timeSeconds, 0.01);
        EXPECT_FALSE(stroke.samples[1].forceNewtons);
    }
    EXPECT_THAT(complaintAbout("t;x;y;z\n0;0,5;0.5;0\n"), HasSubstr("stroke.csv:2: column y"));
    EXPECT_THAT(complaintAbout("t;x;y;z\n0;0;0;0;0,1\n"), HasSubstr("stroke.csv:2: expected 4 values"));
    const Stroke epoch = parseStroke("t;x;y;z\n1700000000,25;0;0;0\n1700000000,5;1;0;0\n", "s");
    EXPECT_DOUBLE_EQ(epoch.samples[1].timeSeconds, 0.25);
}

/// A tip that moves back and forth with up to 0.13 m/s, at a rate, in a unit of time.
std::string strokeAt(double rowsPerSecond, double unitsPerSecond, int rows, double amplitudeMetres = 0.04) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(10);
    text << "t,x,y,z\n";
    for (int row = 0; row < rows; ++row) {
        const double seconds = row / rowsPerSecond;
        text << seconds * unitsPerSecond << ',' << amplitudeMetres * std::sin(3.3 * seconds) << ",0,0\n";
    }
    return text.str();
}

TEST(StrokeFileTest, TimesInAnotherUnitAreRefusedWithItsName) {
    for (const double each : {30.0, 72.0, 90.0, 120.0, 500.0, 1000.0}) {
        SCOPED_TRACE(each);
        const int rows = static_cast<int>(3.0 * each);
        EXPECT_EQ(complaintAbout(strokeAt(each, 1.0, rows)), "no complaint");
        EXPECT_THAT(complaintAbout(strokeAt(each, 1e3, rows)),
                    AllOf(HasSubstr("stroke.csv: column t: rises by "),
                          HasSubstr("expected seconds: are these milliseconds? Divide them by 1000")));
        EXPECT_THAT(complaintAbout(strokeAt(each, 1e6, rows)), HasSubstr("are these microseconds?"));
        EXPECT_EQ(complaintAbout(strokeAt(each, 1.0, rows, 0.0)), "no complaint");
    }
    EXPECT_THAT(complaintAbout(strokeAt(90.0, 1e3, 200, 0.0)), HasSubstr("are these milliseconds?"));
}

TEST(StrokeFileTest, AGapOfManyMinutesIsRefusedAndWaypointsAndSlowStrokesAreNot) {
    EXPECT_THAT(complaintAbout("t,x,y,z\n0,0,0,0\n0.01,0,0,0\n7200,0,0,0\n7200.01,0,0,0\n"),
                HasSubstr("stroke.csv:4: column t: is 7200 s after the line above; expected steps of 600 s at most"));
    EXPECT_EQ(complaintAbout("t,x,y,z\n0,0,0,0\n30,0,0,0\n31,0.05,0,0\n32,0,0,0\n"), "no complaint");
    EXPECT_EQ(complaintAbout("t,x,y,z\n0,0,0,0\n100,0.05,0,0\n"), "no complaint");
    EXPECT_EQ(complaintAbout(strokeAt(90.0, 1.0, 900, 0.0002)), "no complaint");
    EXPECT_EQ(complaintAbout(strokeAt(1.0, 1.0, 20, 0.05)), "no complaint");
}

TEST(StrokeFileTest, SecondsSince1970CountFromTheFirstRowWithEveryDigit) {
    const Stroke stroke = parseStroke(
        "t,x,y,z\n1700000000.999999987,0,0,0\n1700000001.000000012,1,0,0\n1.7000000025e9,2,0,0\n", "stroke.csv");
    ASSERT_EQ(stroke.samples.size(), 3U);
    EXPECT_EQ(stroke.samples[0].timeSeconds, 0.0);
    EXPECT_NEAR(stroke.samples[1].timeSeconds, 25e-9, 1e-15);
    EXPECT_NEAR(stroke.samples[2].timeSeconds, 1.500000013, 1e-12);
    const Stroke negative = parseStroke("t,x,y,z\n-2000000000.25,0,0,0\n-1999999999.5,0,0,0\n", "stroke.csv");
    EXPECT_DOUBLE_EQ(negative.samples[1].timeSeconds, 0.75);
    EXPECT_THAT(complaintAbout("t,x,y,z\n1700000000001,0,0,0\n"),
                HasSubstr("column t: expected seconds within +-1e11"));
    EXPECT_THAT(complaintAbout("t,x,y,z\n0,0,0,0\n2e9,0,0,0\n"), HasSubstr("stroke.csv:3: column t: expected a time "));
    EXPECT_THAT(complaintAbout("t,x,y,z\n1700000001,0,0,0\n1700000000.9999,0,0,0\n"),
                HasSubstr("stroke.csv:3: column t: expected a time not before the line above"));
}

TEST(StrokeFileTest, ErrorsNameFileLineAndColumn) {
    EXPECT_THAT(complaintAbout(""), HasSubstr("stroke.csv:1: expected the header t,x,y,z"));
    EXPECT_THAT(complaintAbout("t,x,y\n"), HasSubstr("stroke.csv:1: expected the header"));
    EXPECT_THAT(complaintAbout("t/x/y/z\n0/0/0/0\n"), HasSubstr("found \"t/x/y/z\""));
    EXPECT_THAT(complaintAbout("\xFF\xFEt\0,\0x\0"), HasSubstr("stroke.csv:1: is text in UTF-16; expected UTF-8"));
    EXPECT_THAT(complaintAbout("t,x,y,z,qx\n"), HasSubstr("expected the header"));
    EXPECT_THAT(complaintAbout("t,x,y,z\n"), HasSubstr("stroke.csv:1: expected one or more samples"));
    EXPECT_THAT(complaintAbout("t,x,y,z\n0,0,0,0\n1,0,0,0\n0.5,0,0,0\n"), HasSubstr("stroke.csv:4: column t"));
    EXPECT_THAT(complaintAbout("t,x,y,z\n0,0,zero,0\n"),
                AllOf(HasSubstr("stroke.csv:2: column y: "), HasSubstr("found \"zero\"")));
    EXPECT_THAT(complaintAbout("t,x,y,z\n0,0,0,0\n1,0,0\n"), HasSubstr("stroke.csv:3: expected 4 values"));
    EXPECT_THAT(complaintAbout("t,x,y,z\n0,5,0,0,0\n"), HasSubstr("decimals need a point"));
    EXPECT_THAT(complaintAbout("t,x,y,z\n0,0,0,nan\n"), HasSubstr("stroke.csv:2: column z"));
    EXPECT_THAT(complaintAbout("t,x,y,z\ninf,0,0,0\n"), HasSubstr("stroke.csv:2: column t"));
    EXPECT_THAT(complaintAbout("t,x,y,z\n0,1e400,0,0\n"), HasSubstr("stroke.csv:2: column x"));
    EXPECT_THAT(complaintAbout("t,x,y,z\n0,1m,0,0\n"), HasSubstr("stroke.csv:2: column x"));
    EXPECT_THAT(complaintAbout("t,x,y,z\n0,+-1,0,0\n"), HasSubstr("stroke.csv:2: column x"));
    EXPECT_THAT(complaintAbout("t,x,y,z\n0,,0,0\n"), HasSubstr("stroke.csv:2: column x"));
    EXPECT_THAT(complaintAbout("t,x,y,z\n0,0,0,0\n\n1,0,0,0\n"), HasSubstr("stroke.csv:3: an empty line"));
    EXPECT_THAT(complaintAbout("t,x,y,z,force\n0,0,0,0,-1\n"), HasSubstr("stroke.csv:2: column force"));
    EXPECT_THAT(complaintAbout("t,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,0\n"), HasSubstr("stroke.csv:2: column qx"));
    EXPECT_THROW(static_cast<void>(readStrokeFile("no/such/stroke.csv")), InputError);
}

class CommaDecimals : public std::numpunct<char> {
protected:
    [[nodiscard]] char do_decimal_point() const override { return ','; }
};

TEST(StrokeFileTest, NumbersNeedADecimalPointInEveryLocale) {
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new CommaDecimals));
    // Also in the C library's locale, if the system has it.
    std::setlocale(LC_NUMERIC, "de_DE.UTF-8");
    const Stroke stroke = parseStroke("t,x,y,z\n0.25,0,0,0\n", "s");
    std::locale::global(before);
    std::setlocale(LC_NUMERIC, "C");
    EXPECT_DOUBLE_EQ(stroke.samples[0].timeSeconds, 0.25);
}

TEST(StrokeFileTest, TheTipBetweenSamplesIsOnAStraightLineAndTurnsTheShorterWay) {
    const Stroke stroke = parseStroke(
        "t,x,y,z,force,qx,qy,qz,qw\n"
        "1,0,0,0,1,0,0,0,1\n"
        "2,4,0,0,3,0,-1,0,0\n",
        "s");
    const TipSample tip = sampleStroke(stroke, 1.25);
    EXPECT_DOUBLE_EQ(tip.timeSeconds, 1.25);
    EXPECT_DOUBLE_EQ(tip.positionMetres.x, 1.0);
    EXPECT_DOUBLE_EQ(tip.forceNewtons.value_or(0.0), 1.5);
    ASSERT_TRUE(tip.orientation);
    EXPECT_NEAR(std::abs(tip.orientation->w), std::cos(std::numbers::pi / 8.0), 1e-9);
    EXPECT_DOUBLE_EQ(sampleStroke(stroke, 0.0).positionMetres.x, 0.0);
    EXPECT_DOUBLE_EQ(sampleStroke(stroke, 9.0).positionMetres.x, 4.0);
    EXPECT_DOUBLE_EQ(sampleStroke(stroke, 9.0).timeSeconds, 9.0);
}

TEST(StrokeFileTest, OfSeveralSamplesAtTheSameTimeTheLastIsUsed) {
    const Stroke stroke = parseStroke("t,x,y,z\n0,0,0,0\n1,1,0,0\n1,5,0,0\n2,6,0,0\n", "s");
    EXPECT_DOUBLE_EQ(sampleStroke(stroke, 1.0).positionMetres.x, 5.0);
    EXPECT_NEAR(sampleStroke(stroke, 0.999999).positionMetres.x, 1.0, 1e-5);
}

TEST(StrokeFileTest, FramesRunFromTheFirstSampleToTheLast) {
    const Stroke stroke = parseStroke("t,x,y,z\n5,0,0,0\n6,1,0,0\n", "s");
    ASSERT_EQ(frameCount(stroke, 90.0, "s"), 91U);
    EXPECT_DOUBLE_EQ(frameAt(stroke, 90.0, 0).timeSeconds, 5.0);
    EXPECT_NEAR(frameAt(stroke, 90.0, 45).positionMetres.x, 0.5, 1e-12);
    EXPECT_NEAR(frameAt(stroke, 90.0, 90).timeSeconds, 6.0, 1e-12);
    EXPECT_EQ(frameCount(parseStroke("t,x,y,z\n5,0,0,0\n", "s"), 90.0, "s"), 1U);
    EXPECT_THROW(static_cast<void>(frameCount(parseStroke("t,x,y,z\n0,0,0,0\n1e9,0,0,0\n", "s"), 90.0, "s")),
                 InputError);
}

using ::testing::ElementsAre;

const std::vector<std::string> labels{"wood", "plywood", "stone", "metal", "metal mesh", "fur", "rubber"};

TEST(NearWordsTest, AWordIsSuggestedForOneThatIsALetterOffOrHasTwoSwapped) {
    for (const char* word : {"wood", "wod", "woood", "wold", "owod", "WOOD"}) {
        EXPECT_EQ(suggestion(word, labels), "did you mean 'wood'?") << word;
    }
    EXPECT_EQ(suggestion("METAL-Mesh", labels), "did you mean 'metal mesh'?");
    EXPECT_EQ(suggestion("xylophone", labels), "");
    EXPECT_EQ(didYouMean(std::array<std::string, 3>{"a", "b", "c"}), "did you mean 'a', 'b' or 'c'?");
}

TEST(NearWordsTest, TheNearestIsFirstAndAmongEquallyNearOnesTheOneThatContainsTheWord) {
    EXPECT_THAT(nearestWords("wod", labels, 3), ElementsAre("wood", "fur", "plywood"));
    EXPECT_THAT(nearestWords("mesh", std::array<std::string, 2>{"carpeting", "mesh wire"}, 2),
                ElementsAre("mesh wire", "carpeting"));
    EXPECT_THAT(nearestWords("wood", {}, 3), ElementsAre());
}

}  // namespace
}  // namespace haptoflow::headless
