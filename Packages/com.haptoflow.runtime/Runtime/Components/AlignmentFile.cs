#nullable enable
using System;
using System.IO;
using HaptoFlow.Alignment;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The file in the player's persistent folder that keeps an alignment between sessions. Main
    /// thread.</summary>
    internal readonly struct AlignmentFile
    {
        private readonly string path;

        /// <param name="name">Name of the alignment. Characters other than letters, digits and hyphens become
        /// underscores.</param>
        public AlignmentFile(string name)
        {
            char[] letters = name.ToCharArray();
            for (int index = 0; index < letters.Length; ++index)
            {
                bool plain = char.IsLetterOrDigit(letters[index]) || letters[index] == '-';
                letters[index] = plain ? letters[index] : '_';
            }
            path = Path.Combine(Application.persistentDataPath, "HaptoFlow", new string(letters) + ".pose.json");
        }

        public bool TryRead(out RigidPose pose, UnityEngine.Object context)
        {
            bool found = SavedPose.TryRead(path, out pose, out string? problem);
            if (problem != null)
            {
                Debug.LogWarning($"HaptoFlow: {problem}.", context);
            }
            return found;
        }

        public void Write(in RigidPose pose, UnityEngine.Object context)
        {
            try
            {
                SavedPose.Write(path, pose);
            }
            catch (Exception error) when (error is IOException || error is UnauthorizedAccessException)
            {
                Debug.LogWarning($"HaptoFlow: {path}: {error.Message}; the alignment is lost when the " +
                    "application ends; make the folder writable to keep it.", context);
            }
        }

        public void Delete(UnityEngine.Object context)
        {
            try
            {
                SavedPose.Delete(path);
            }
            catch (Exception error) when (error is IOException || error is UnauthorizedAccessException)
            {
                Debug.LogWarning($"HaptoFlow: {path}: {error.Message}; delete the file by hand.", context);
            }
        }
    }
}
