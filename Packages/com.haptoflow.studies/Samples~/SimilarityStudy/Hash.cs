#nullable enable
using System.Linq;
using System.Security.Cryptography;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>Hashes that identify in a log which bytes a study used.</summary>
    internal static class Hash
    {
        /// <summary>The SHA-256 of the bytes as 64 hex digits. Unity 2022.3 has no Convert.ToHexString.</summary>
        public static string Sha256(byte[] bytes)
        {
            using SHA256 hash = SHA256.Create();
            return string.Concat(hash.ComputeHash(bytes).Select(each => each.ToString("x2")));
        }
    }
}
