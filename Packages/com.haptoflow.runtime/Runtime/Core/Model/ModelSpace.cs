#nullable enable
using System;
using System.Buffers.Binary;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using System.Text;

namespace HaptoFlow.Model
{
    /// <summary>The embedding space of a model, read without the native library. A learnt material can be used only
    /// with models of the space that it was learnt in. Any thread.</summary>
    public sealed class ModelSpace
    {
        private const string EmbeddingBlob = "embedding";

        private readonly string[] names;
        private readonly float[][] embeddings;

        private ModelSpace(string id, string[] names, float[][] embeddings)
        {
            Id = id;
            this.names = names;
            this.embeddings = embeddings;
        }

        /// <summary>Eight hexadecimal digits, equal for all models with the same networks, whatever their
        /// labels.</summary>
        public string Id { get; }

        /// <param name="file">The whole .haptoflow file.</param>
        /// <exception cref="HaptoFlowException">The bytes break a rule of the format; the message names it.</exception>
        public static ModelSpace Of(ReadOnlySpan<byte> file)
        {
            string text = ModelFile.HeaderText(file);
            try
            {
                JsonValue header = JsonValue.Parse(text);
                JsonValue[] labels = header["labels"].AsArray().ToArray();
                float[][] rows = Rows(file, header);
                return new ModelSpace(IdOf(header), labels.Select(label => label["name"].AsText()).ToArray(),
                    labels.Select(label => RowOf(label, rows)).ToArray());
            }
            catch (FormatException error)
            {
                throw new HaptoFlowException(
                    HaptoFlowStatus.ModelInconsistent, "the JSON header: " + error.Message, error);
            }
        }

        /// <summary>The embedding of a label, <see cref="HapticModel.EmbeddingSize"/> numbers. Do not
        /// modify.</summary>
        /// <param name="label">Index into the model's labels.</param>
        public IReadOnlyList<float> Embedding(int label) => embeddings[label];

        /// <summary>The label whose embedding is nearest, ignoring wave vectors; empty for a model without
        /// labels.</summary>
        /// <param name="embedding">At least <see cref="MaterialFile.TextureNumbers"/> numbers.</param>
        public string NearestLabel(IReadOnlyList<double> embedding)
        {
            string nearest = "";
            double minimum = double.PositiveInfinity;
            for (int label = 0; label < embeddings.Length; ++label)
            {
                double squares = 0.0;
                for (int index = 0; index < MaterialFile.TextureNumbers; ++index)
                {
                    double difference = embedding[index] - embeddings[label][index];
                    squares += difference * difference;
                }
                if (squares < minimum)
                {
                    minimum = squares;
                    nearest = names[label];
                }
            }
            return nearest;
        }

        private static string IdOf(JsonValue header)
        {
            var checksums = new Dictionary<string, double>(StringComparer.Ordinal);
            foreach (JsonValue blob in header["blobs"].AsArray())
            {
                checksums[blob["name"].AsText()] = blob["crc32"].AsNumber();
            }
            var text = new StringBuilder();
            foreach (JsonValue tier in header["tiers"].AsArray())
            {
                JsonValue field = tier["field"];
                if (!checksums.TryGetValue(field.AsText(), out double checksum))
                {
                    throw field.Expected("the name of a blob");
                }
                text.Append(tier["name"].AsText()).Append(':')
                    .Append(((uint)checksum).ToString("x8", CultureInfo.InvariantCulture)).Append(';');
            }
            return Crc32.Of(Encoding.ASCII.GetBytes(text.ToString())).ToString("x8", CultureInfo.InvariantCulture);
        }

        private static float[] RowOf(JsonValue label, float[][] rows)
        {
            JsonValue row = label["embedding_row"];
            int index = row.AsInteger();
            return index >= 0 && index < rows.Length ? rows[index] : throw row.Expected("a row of the embeddings");
        }

        private static float[][] Rows(ReadOnlySpan<byte> file, JsonValue header)
        {
            JsonValue blob = header["blobs"].AsArray().FirstOrDefault(each => each["name"].AsText() == EmbeddingBlob) ??
                throw new FormatException($"blobs has none with the name \"{EmbeddingBlob}\"");
            double offset = blob["offset"].AsNumber();
            double bytes = blob["bytes"].AsNumber();
            const int rowBytes = sizeof(float) * HapticModel.EmbeddingSize;
            if (!(offset >= 0.0 && bytes >= 0.0 && offset + bytes <= file.Length && bytes % rowBytes == 0.0))
            {
                throw blob.Expected("rows of 64 numbers inside the file");
            }
            var rows = new float[(int)bytes / rowBytes][];
            for (int row = 0; row < rows.Length; ++row)
            {
                rows[row] = new float[HapticModel.EmbeddingSize];
                for (int index = 0; index < HapticModel.EmbeddingSize; ++index)
                {
                    int place = (int)offset + row * rowBytes + index * sizeof(float);
                    rows[row][index] = BitConverter.Int32BitsToSingle(
                        BinaryPrimitives.ReadInt32LittleEndian(file.Slice(place, sizeof(float))));
                }
            }
            return rows;
        }
    }
}
