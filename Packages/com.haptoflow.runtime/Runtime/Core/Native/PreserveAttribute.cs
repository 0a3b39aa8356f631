#nullable enable
using System;

namespace HaptoFlow.Native
{
    /// <summary>Keeps Unity's linker from stripping fields that no managed code reads but that are part of a native
    /// layout. The linker matches the attribute by name.</summary>
    [AttributeUsage(AttributeTargets.Class | AttributeTargets.Struct)]
    internal sealed class PreserveAttribute : Attribute
    {
    }
}
