using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using HaptoFlow.Recordings;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>Recordings in every format of own-materials.md, and the errors for invalid ones.</summary>
    public sealed class RecordingReaderTests
    {
        private readonly Dictionary<string, byte[]> folder = new Dictionary<string, byte[]>();

        [SetUp]
        public void Empty() => folder.Clear();

        private void Put(string name, string text) => folder[name] = Encoding.UTF8.GetBytes(text);

        private Recording Read(string name, double? fullScale = null) => RecordingReader.Read(
            name, folder[name], sibling => folder.TryGetValue(sibling, out byte[]? bytes) ? bytes : null, fullScale);

        private string Refusal(string name, double? fullScale = null)
        {
            var refusal = Assert.Throws<HaptoFlowException>(() => Read(name, fullScale))!;
            Assert.That(refusal.Status, Is.EqualTo(HaptoFlowStatus.RecordingUnusable));
            return refusal.Message;
        }

        /// <summary>Creates a table of a wave of 100 Hz and 2 m/s^2, with further columns.</summary>
        private static string Table(string columns, Func<int, double, string> row, int rows = 2000, double rateHz = 2000.0)
        {
            var text = new StringBuilder(columns + "\n");
            for (int index = 0; index < rows; ++index)
            {
                text.Append(row(index, index / rateHz)).Append('\n');
            }
            return text.ToString();
        }

        private static string Words(params double[] numbers) =>
            string.Join(",", numbers.Select(number => number.ToString("R", CultureInfo.InvariantCulture)));

        private static double Wave(double seconds) => 2.0 * Math.Sin(200.0 * Math.PI * seconds);

        private static string Plain(string motion = ",speed_mps,force_newtons", string values = ",0.08,1.5") => Table(
            "time_s,acceleration_mps2" + motion, (_, seconds) => Words(seconds, Wave(seconds)) + values);

        private static byte[] Wav(short channels, int rateHz, short tag, short bits, params double[] samples)
        {
            var file = new MemoryStream();
            using var writer = new BinaryWriter(file);
            writer.Write(Encoding.ASCII.GetBytes("RIFF"));
            writer.Write(36 + samples.Length * bits / 8);
            writer.Write(Encoding.ASCII.GetBytes("WAVEfmt "));
            writer.Write(16);
            writer.Write(tag);
            writer.Write(channels);
            writer.Write(rateHz);
            writer.Write(rateHz * channels * bits / 8);
            writer.Write((short)(channels * bits / 8));
            writer.Write(bits);
            writer.Write(Encoding.ASCII.GetBytes("data"));
            writer.Write(samples.Length * bits / 8);
            foreach (double sample in samples)
            {
                switch (bits)
                {
                    case 8:
                        writer.Write((byte)Math.Round(128.0 + 127.0 * sample));
                        break;
                    case 16:
                        writer.Write((short)Math.Round(32767.0 * sample));
                        break;
                    case 24:
                        int whole = (int)Math.Round(8388607.0 * sample);
                        writer.Write(new[] { (byte)whole, (byte)(whole >> 8), (byte)(whole >> 16) });
                        break;
                    case 32 when tag == 1:
                        writer.Write((int)Math.Round(2147483647.0 * sample));
                        break;
                    case 32:
                        writer.Write((float)sample);
                        break;
                    default:
                        writer.Write(sample);
                        break;
                }
            }
            return file.ToArray();
        }

        private static double[] Waves(int count, double rateHz) =>
            Enumerable.Range(0, count).Select(index => 0.5 * Math.Sin(200.0 * Math.PI * index / rateHz)).ToArray();

        private static void AssertIsTheWave(Recording recording, double tolerance = 1e-4)
        {
            for (int sample = 0; sample < recording.SampleCount; sample += 7)
            {
                Assert.That(recording.AccelerationMps2[sample * recording.AxisCount],
                    Is.EqualTo(Wave(sample / recording.SampleRateHz)).Within(tolerance), $"sample {sample}");
            }
        }

        [Test]
        public void ATableOfOneAxisWithSpeedAndForceInColumnsIsReadWhole()
        {
            Put("denim.csv", Plain());
            Recording recording = Read("denim.csv");
            Assert.That((recording.Name, recording.AxisCount, recording.SampleCount), Is.EqualTo(("denim", 1, 2000)));
            Assert.That(recording.SampleRateHz, Is.EqualTo(2000.0).Within(1e-6));
            Assert.That(recording.Seconds, Is.EqualTo(1.0).Within(1e-6));
            Assert.That(recording.VelocityAt(1000).X, Is.EqualTo(0.08).Within(1e-7));
            Assert.That(recording.ForceAt(1000), Is.EqualTo(1.5).Within(1e-6));
            Assert.That(recording.KnowsMotion, Is.True);
            AssertIsTheWave(recording);
        }

        [TestCase("acceleration_g", 1.0 / 9.80665)]
        [TestCase("acceleration_mps2", 1.0)]
        public void AccelerationsAreReadByTheirUnit(string column, double scale)
        {
            Put("a.csv", Table("time_s," + column, (_, seconds) => Words(seconds, scale * Wave(seconds))));
            AssertIsTheWave(Read("a.csv"));
        }

        [TestCase("speed_mmps", "80")]
        [TestCase("speed_mps", "0.08")]
        public void SpeedsAreReadByTheirUnit(string column, string value)
        {
            Put("a.csv", Plain("," + column, "," + value));
            Recording recording = Read("a.csv");
            Assert.That(recording.VelocityAt(500), Is.EqualTo((recording.VelocityAt(0).X, 0.0)));
            Assert.That(recording.VelocityAt(500).X, Is.EqualTo(0.08).Within(1e-6));
            Assert.That(recording.KnowsMotion, Is.False, "the force is unknown");
            Assert.That(recording.With(null, 2.0).KnowsMotion, Is.True);
        }

        [TestCase("position_x_mm,position_y_mm", 1000.0)]
        [TestCase("position_x_m,position_y_m", 1.0)]
        public void PositionsAreDifferentiatedWithoutTheQuantisationOfTheTracker(string columns, double scale)
        {
            Put("a.csv", Table("time_s,acceleration_mps2," + columns, (_, seconds) => Words(seconds, Wave(seconds),
                Math.Round(60.0 * seconds, 1) / 1000.0 * scale, Math.Round(-25.0 * seconds, 1) / 1000.0 * scale)));
            Recording recording = Read("a.csv");
            for (int sample = 0; sample < 2000; sample += 100)
            {
                (double x, double y) = recording.VelocityAt(sample);
                Assert.That(x, Is.EqualTo(0.06).Within(0.006));
                Assert.That(y, Is.EqualTo(-0.025).Within(0.006));
            }
        }

        [Test]
        public void ThreeAxesMillinewtonsAndQuotedNamesAreRead()
        {
            Put("a.csv", Table(
                "\"time_s\",\"acceleration_x_mps2\",acceleration_y_mps2, acceleration_z_mps2,force_millinewtons",
                (_, seconds) => Words(seconds, Wave(seconds), 1.0, 9.81, 1200.0)).Replace("\n", "\r\n"));
            Recording recording = Read("a.csv");
            Assert.That((recording.AxisCount, recording.SampleCount), Is.EqualTo((3, 2000)));
            Assert.That(recording.AccelerationMps2[3 * 100 + 2], Is.EqualTo(9.81f).Within(1e-5f));
            Assert.That(recording.ForceAt(7), Is.EqualTo(1.2).Within(1e-6));
            AssertIsTheWave(recording);
        }

        [TestCase((short)1, (short)8, 0.02)]
        [TestCase((short)1, (short)16, 1e-3)]
        [TestCase((short)1, (short)24, 1e-4)]
        [TestCase((short)1, (short)32, 1e-4)]
        [TestCase((short)3, (short)32, 1e-4)]
        [TestCase((short)3, (short)64, 1e-4)]
        public void AWavFileIsScaledByItsSidecar(short tag, short bits, double tolerance)
        {
            folder["denim.wav"] = Wav(1, 8000, tag, bits, Waves(4000, 8000.0));
            Put("denim.json", "{\"full_scale_mps2\": 4, \"speed_mps\": 0.1, \"force_newtons\": 1, \"label\": \"denim\"," +
                " \"licence\": \"CC BY 4.0\", \"source\": \"a lab\"}");
            Recording recording = Read("denim.wav");
            Assert.That((recording.SampleRateHz, recording.SampleCount), Is.EqualTo((8000.0, 4000)).Within(1e-6));
            Assert.That((recording.Label, recording.Licence, recording.Source),
                Is.EqualTo(("denim", "CC BY 4.0", "a lab")));
            Assert.That(recording.ConstantVelocityMps, Is.EqualTo((0.1, 0.0)));
            Assert.That(recording.KnowsMotion, Is.True);
            AssertIsTheWave(recording, 4.0 * tolerance);
        }

        [Test]
        public void AWavFileOfThreeChannelsHasThreeAxes()
        {
            double[] wave = Waves(2000, 2000.0);
            folder["a.wav.bytes"] = Wav(3, 2000, 3, 32, wave.SelectMany(value => new[] { value, 0.1, -0.2 }).ToArray());
            Recording recording = Read("a.wav.bytes", 4.0);
            Assert.That((recording.Name, recording.AxisCount), Is.EqualTo(("a", 3)));
            AssertIsTheWave(recording);
        }

        [Test]
        public void TheSidecarOverridesTheFoldersDefaultsAndAMotionFileHasItsOwnClock()
        {
            Put("recordings.json", "{\"speed_mps\": 0.5, \"force_newtons\": 3, \"licence\": \"MIT\", \"label\": \"x\"}");
            Put("a.json", "{\"label\": \"denim\", \"force_newtons\": 1, \"motion\": \"a.motion.csv\"}");
            Put("a.motion.csv", Table("time_s,velocity_x_mps,velocity_y_mps",
                (_, seconds) => Words(seconds, 0.1 * seconds, 0.05), 101, 100.0));
            Put("a.csv", Plain("", ""));
            Recording recording = Read("a.csv");
            Assert.That((recording.Label, recording.Licence), Is.EqualTo(("denim", "MIT")));
            Assert.That(recording.ForceAt(3), Is.EqualTo(1.0));
            Assert.That(recording.VelocityAt(1000).X, Is.EqualTo(0.05).Within(1e-4));
            Assert.That(recording.VelocityAt(1000).Y, Is.EqualTo(0.05).Within(1e-6));
        }

        [Test]
        public void ATableWithoutTimesHasTheRateOfItsSidecar()
        {
            Put("a.csv", Table("acceleration_mps2", (_, seconds) => Words(Wave(seconds))));
            Assert.That(Refusal("a.csv"), Does.Contain("without time_s").And.Contain("rate_hz"));
            Put("a.json", "{\"rate_hz\": 2000}");
            AssertIsTheWave(Read("a.csv"));
        }

        [Test]
        public void MissingNumbersRemoveOnlyTheirNeighbourhood()
        {
            Put("a.csv", Table("time_s,acceleration_mps2", (index, seconds) => index == 700
                ? Words(seconds) + ","
                : Words(seconds + (index > 1000 ? 0.007 : 0.0), Wave(seconds + (index > 1000 ? 0.007 : 0.0)))));
            Recording recording = Read("a.csv");
            Assert.That(recording.SampleRateHz, Is.EqualTo(2000.0).Within(1e-6));
            Assert.That(recording.SampleCount, Is.EqualTo(2014));
            foreach (int sample in new[] { 690, 710, 990, 1020, 2000 })
            {
                Assert.That(recording.AccelerationMps2[sample], Is.EqualTo(Wave(sample / 2000.0)).Within(1e-3), $"{sample}");
            }
        }

        [Test]
        public void UnknownColumnsAreIgnoredAndListed()
        {
            Put("a.csv", Plain(",temperature,note", ",21,warm"));
            Assert.That(Read("a.csv").Remarks.Single(), Does.Contain("temperature, note"));
        }

        [TestCase("", "empty file")]
        [TestCase("time_s,acceleration_mps2\n", "0 rows")]
        [TestCase("time_s,acceleration\n0,1\n", "columns time_s, acceleration; expected acceleration:")]
        [TestCase("time_s;acceleration_mps2\n0;1\n", "semicolons")]
        [TestCase("time_s,time_s,acceleration_mps2\n0,0,1\n", "column time_s twice")]
        [TestCase("time_s,acceleration_x_mps2,acceleration_y_mps2\n0,1,1\n", "without acceleration_z_mps2")]
        [TestCase("time_s,acceleration_mps2,acceleration_g\n0,1,1\n", "several forms")]
        [TestCase("time_s,acceleration_mps2,speed_mps,speed_mmps\n0,1,1,1\n", "several forms")]
        [TestCase("time_s,acceleration_mps2\n0,1\n0.001,oops\n", "\"oops\" in row 3, column acceleration_mps2")]
        [TestCase("time_s,acceleration_mps2\n0,1\n0.001,NaN\n0.002,3\n0.003,1\n", "no number in row 3")]
        [TestCase("time_s,acceleration_mps2\n0,1\n0.001,2\n0.001,3\n0.003,1\n", "does not rise in row 4")]
        [TestCase("time_s,acceleration_mps2\n0,1\n0.1,2\n0.2,3\n0.3,1\n", "10 samples a second; expected 1000")]
        [TestCase("time_s,acceleration_mps2\n0,1\n0.001,1\n0.002,1\n0.003,1\n", "stays the same")]
        public void AnInvalidTableIsRefusedWithWhatWasFound(string text, string message)
        {
            Put("a.csv", text);
            Assert.That(Refusal("a.csv"), Does.StartWith("a.csv: ").And.Contain(message).And.Contain("expected"));
        }

        [TestCase(",speed_mps", ",80", "speed_mps gives a speed of 80 m/s", "speed_mmps")]
        [TestCase(",speed_mmps", ",0.08", "speed_mmps gives a speed of 0 m/s", "speed_mps")]
        [TestCase(",force_newtons", ",1200", "force_newtons is 1200 N", "force_millinewtons")]
        public void ANumberInAnotherUnitIsRefusedWithTheIntendedColumn(
            string column, string value, string found, string remedy)
        {
            Put("a.csv", Plain(column, value));
            Assert.That(Refusal("a.csv"), Does.Contain(found).And.Contain(remedy));
        }

        [Test]
        public void GravityInAnotherUnitIsReported()
        {
            const string g = "time_s,acceleration_x_g,acceleration_y_g,acceleration_z_g";
            Put("a.csv", Table(g, (_, seconds) => Words(seconds, Wave(seconds), 0.0, 9.81)));
            Assert.That(Refusal("a.csv"), Does.Contain("looks like m/s^2"));
            Put("a.csv", Table(g.Replace("_g", "_mps2"), (_, seconds) => Words(seconds, 0.1 * Wave(seconds), 0.0, 1.0)));
            Assert.That(Refusal("a.csv"), Does.Contain("looks like g"));
        }

        [TestCase("[1]", "expected a JSON object")]
        [TestCase("{\"full_scale\": 4}", "unknown key 'full_scale'")]
        [TestCase("{\"speed_mps\": 80}", "key 'speed_mps' is 80")]
        [TestCase("{\"force_newtons\": \"1\"}", "key 'force_newtons' is \"1\"")]
        [TestCase("{\"velocity_mps\": [1]}", "key 'velocity_mps' is [1]")]
        [TestCase("{\"speed_mps\": 1, \"velocity_mps\": [1, 0]}", "keys speed_mps and velocity_mps")]
        [TestCase("{\"motion\": \"none.csv\"}", "key 'motion' names none.csv, which is not there")]
        [TestCase("{\"motion\": \"../a.csv\"}", "names ../a.csv, which is outside the folder of a.json")]
        [TestCase("{\"motion\": \"x\\\\..\\\\a.csv\"}", "which is outside the folder of a.json")]
        [TestCase("{\"motion\": \"/etc/hosts\"}", "which is outside the folder of a.json")]
        [TestCase("{\"motion\": \"C:a.csv\"}", "which is outside the folder of a.json")]
        [TestCase("{\"\\u001b[2J\": 1}", "unknown key '\\u001B[2J'")]
        public void AnInvalidSidecarIsRefusedWithItsKey(string sidecar, string message)
        {
            Put("a.csv", Plain());
            Put("a.json", sidecar);
            Assert.That(Refusal("a.csv"), Does.StartWith("a.json: ").And.Contain(message));
        }

        [Test]
        public void AWavFileWithoutAScaleOrInAnotherFormatIsRefused()
        {
            folder["a.wav"] = Wav(1, 2000, 1, 16, Waves(100, 2000.0));
            Assert.That(Refusal("a.wav"), Does.Contain("no key 'full_scale_mps2' for a.wav"));
            folder["a.wav"] = Wav(2, 2000, 1, 16, Waves(100, 2000.0));
            Assert.That(Refusal("a.wav", 4.0), Does.Contain("2 channels"));
            folder["a.wav"] = Wav(1, 500, 1, 16, Waves(100, 2000.0));
            Assert.That(Refusal("a.wav", 4.0), Does.Contain("500 samples a second"));
            folder["a.wav"] = Wav(1, 2000, 7, 16, Waves(100, 2000.0));
            Assert.That(Refusal("a.wav", 4.0), Does.Contain("format 7"));
            folder["a.wav"] = Wav(1, 2000, 3, 32, 0.1, double.NaN, 0.2, 0.3);
            Assert.That(Refusal("a.wav", 4.0), Does.Contain("sample 1 is not finite"));
            folder["a.wav"] = Wav(1, 2000, 3, 32);
            Assert.That(Refusal("a.wav", 4.0), Does.Contain("0 samples"));
            folder["a.wav"] = new byte[0];
            Assert.That(Refusal("a.wav", 4.0), Does.Contain("empty file"));
        }

        [Test]
        public void AWavFileTruncatedAtAnyByteIsReadOrRefused()
        {
            byte[] whole = Wav(1, 2000, 1, 24, Waves(30, 2000.0));
            for (int length = 0; length < whole.Length; ++length)
            {
                folder["a.wav"] = whole.AsSpan(0, length).ToArray();
                try
                {
                    Assert.That(Read("a.wav", 4.0).SampleCount, Is.LessThan(30));
                }
                catch (HaptoFlowException refusal)
                {
                    Assert.That(refusal.Status, Is.EqualTo(HaptoFlowStatus.RecordingUnusable));
                }
            }
        }

        [Test]
        public void AMissingFileOrOneWithAnotherExtensionIsRefused()
        {
            Assert.That(Assert.Throws<HaptoFlowException>(() => RecordingReader.Read("nowhere.csv"))!.Message,
                Does.Contain("nowhere.csv: is not there"));
            Put("a.mp3", "x");
            Assert.That(Refusal("a.mp3"), Does.Contain("ending \".mp3\""));
        }
    }
}
