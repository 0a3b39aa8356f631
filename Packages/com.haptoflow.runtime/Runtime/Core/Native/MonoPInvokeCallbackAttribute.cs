#nullable enable
using System;

namespace HaptoFlow.Native
{
    /// <summary>Makes Unity's ahead-of-time compiler create a native entry point for a static method. It matches the
    /// attribute by name, and this assembly has no reference to UnityEngine's own.</summary>
    [AttributeUsage(AttributeTargets.Method)]
    internal sealed class MonoPInvokeCallbackAttribute : Attribute
    {
        /// <param name="type">The delegate type of the method.</param>
        public MonoPInvokeCallbackAttribute(Type type) => Type = type;

        public Type Type { get; }
    }
}
