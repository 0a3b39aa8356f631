using System;
using System.Buffers.Binary;
using System.IO;
using System.Text;
using HaptoFlow.Model;
using HaptoFlow.Tests.Support;

namespace HaptoFlow.PreviewTests
{
    /// <summary>The default model and changed copies of it.</summary>
    internal static class ModelFiles
    {
        private const int PrefixBytes = 32;
        private const int Alignment = 64;

        public static byte[] Default { get; } = File.ReadAllBytes(RepositoryFiles.DefaultModel);

        public static byte[] Damaged()
        {
            byte[] file = (byte[])Default.Clone();
            file[100] ^= 1;
            return file;
        }

        /// <summary>The default model's header, changed as text, in a file without tensors.</summary>
        public static ModelHeader HeaderWith(Func<string, string> change)
        {
            int length = BinaryPrimitives.ReadInt32LittleEndian(Default.AsSpan(12));
            string json = change(Encoding.UTF8.GetString(Default, PrefixBytes, length).TrimEnd(' '));
            int padded = (PrefixBytes + Encoding.UTF8.GetByteCount(json) + Alignment - 1) / Alignment * Alignment;
            var file = new byte[padded];
            Default.AsSpan(0, PrefixBytes).CopyTo(file);
            file.AsSpan(PrefixBytes).Fill((byte)' ');
            Encoding.UTF8.GetBytes(json, file.AsSpan(PrefixBytes));
            BinaryPrimitives.WriteInt32LittleEndian(file.AsSpan(12), padded - PrefixBytes);
            BinaryPrimitives.WriteInt64LittleEndian(file.AsSpan(16), padded);
            BinaryPrimitives.WriteUInt32LittleEndian(file.AsSpan(24), Crc32.Of(file.AsSpan(PrefixBytes)));
            BinaryPrimitives.WriteUInt32LittleEndian(file.AsSpan(28), Crc32.Of(file.AsSpan(0, 28)));
            return ModelHeader.Read(file);
        }
    }
}
