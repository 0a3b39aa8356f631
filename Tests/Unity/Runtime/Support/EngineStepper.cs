#nullable enable
using UnityEngine;

namespace HaptoFlow.Tests
{
    /// <summary>Steps the engine once after every frame in place of the worker, so that results do not depend on the
    /// machine.</summary>
    [DefaultExecutionOrder(2000)]
    internal sealed class EngineStepper : MonoBehaviour
    {
        private void LateUpdate() => HapticSession.Existing?.Engine?.Step();
    }
}
