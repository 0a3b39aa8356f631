#nullable enable
using System;
using System.Collections.Generic;
using System.IO;
using HaptoFlow.Files;
using HaptoFlow.Model;
using HaptoFlow.Numerics;

namespace HaptoFlow.Alignment
{
    /// <summary>A pose in a small JSON file: metres and a unit quaternion. Writing is atomic, and every value is
    /// checked on reading. Any thread that may access files.</summary>
    internal static class SavedPose
    {
        private const string Format = "haptoflow pose";
        private const int Version = 1;
        private const int MaximumFileBytes = 4096;
        private const double MaximumMetres = 1000.0;

        // Rounding to six decimals changes the length of a quaternion by less than this.
        private const double LengthTolerance = 1e-3;

        /// <exception cref="IOException">The file cannot be written.</exception>
        /// <exception cref="UnauthorizedAccessException">The file cannot be written.</exception>
        public static void Write(string path, in RigidPose pose)
        {
            Double3 place = pose.PositionMetres;
            Rotation turn = pose.Rotation;
            WholeFile.Write(path, JsonText.Of(new Dictionary<string, object?>
            {
                ["format"] = Format,
                ["version"] = Version,
                ["position_m"] = new[] { place.X, place.Y, place.Z },
                ["rotation_xyzw"] = new[] { turn.X, turn.Y, turn.Z, turn.W },
            }) + "\n");
        }

        /// <summary>False where there is no such file, or it cannot be used.</summary>
        /// <param name="problem">What is wrong with the file; null without a file.</param>
        public static bool TryRead(string path, out RigidPose pose, out string? problem)
        {
            pose = RigidPose.Identity;
            problem = null;
            if (!File.Exists(path))
            {
                return false;
            }
            try
            {
                if (new FileInfo(path).Length > MaximumFileBytes)
                {
                    throw new FormatException("the file is longer than 4096 bytes");
                }
                pose = Parse(JsonValue.Parse(File.ReadAllText(path)));
                return true;
            }
            catch (Exception error) when (error is FormatException || error is IOException ||
                error is UnauthorizedAccessException)
            {
                problem = $"{path}: {error.Message}; delete the file and align again";
                return false;
            }
        }

        public static void Delete(string path) => File.Delete(path);

        private static RigidPose Parse(JsonValue document)
        {
            if (document["format"].AsText() != Format || document["version"].AsInteger() != Version)
            {
                throw new FormatException($"this is not a \"{Format}\" of version {Version}");
            }
            double[] place = Numbers(document["position_m"], 3, MaximumMetres);
            double[] turn = Numbers(document["rotation_xyzw"], 4, 1.0 + LengthTolerance);
            double length = Math.Sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3]);
            if (!(Math.Abs(length - 1.0) <= LengthTolerance))
            {
                throw new FormatException("rotation_xyzw is not of length 1");
            }
            return new RigidPose(
                new Double3(place[0], place[1], place[2]), new Rotation(turn[0], turn[1], turn[2], turn[3]));
        }

        private static double[] Numbers(JsonValue array, int count, double largest)
        {
            if (array.AsArray().Count != count)
            {
                throw new FormatException($"{array.Path} does not hold {count} numbers");
            }
            var numbers = new double[count];
            for (int index = 0; index < count; ++index)
            {
                numbers[index] = array[index].AsNumber();
                if (!(Math.Abs(numbers[index]) <= largest))
                {
                    throw new FormatException($"{array[index].Path} is out of range");
                }
            }
            return numbers;
        }
    }
}
