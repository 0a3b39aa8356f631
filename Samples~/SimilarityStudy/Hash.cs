#nullable enable
using System.Linq;
using System.Security.Cryptography;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>Which bytes a study used, for its log.</summary>
    internal static class Hash
    {
        /// <summary>64 hexadecimal digits.</summary>
        public static string Sha256(byte[] bytes)
        {
            using SHA256 hash = SHA256.Create();
            return string.Concat(hash.ComputeHash(bytes).Select(each => each.ToString("x2")));
        }
    }
}
